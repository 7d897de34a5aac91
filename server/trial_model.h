// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Which body model a recording is solved with.
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"

namespace kinemark::server {

/// The model that was given; else the .osim of the recording's own name beside it, else the only .osim there.
/// None, or several: Code::not_supported, one sentence with the way out. O(files of the folder).
/// @param given  empty: none was
[[nodiscard]] Result<std::filesystem::path> find_model(const std::filesystem::path& recording,
                                                       const std::filesystem::path& given);

}  // namespace kinemark::server
