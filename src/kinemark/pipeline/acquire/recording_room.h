// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/stream/device.h"

namespace kinemark::pipeline {

/// That a trial can be written there: no file of that name, unless `force`, and room for its length, or for a
/// minute where it has none. Code::io with how long the disk has room for.
[[nodiscard]] Status check_room(const std::filesystem::path& file, bool force,
                                const stream::GrantedPlan& plan, double duration_s);

}  // namespace kinemark::pipeline
