// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/data/neural.h"

namespace kinemark::io::internal {

/// read_neural() in this process.
[[nodiscard]] Result<data::Neural> read_neural_here(const std::filesystem::path& path);
/// read_neural_lanes() in this process.
[[nodiscard]] Result<data::Neural> read_lanes_here(const std::filesystem::path& path);

}  // namespace kinemark::io::internal
