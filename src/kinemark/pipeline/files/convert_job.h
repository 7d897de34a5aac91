// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::pipeline {

/// Read one file and write it in the format that `out` ends in; both must be of one kind (markers, tables or
/// models). Returns irregularities of the input and what the new format cannot store, one sentence each.
/// rate_hz: for marker files that store none (.v3d), else 0.
[[nodiscard]] Result<std::vector<std::string>> convert_file(const std::filesystem::path& in,
                                                            const std::filesystem::path& out, bool force,
                                                            double rate_hz = 0.0);

}  // namespace kinemark::pipeline
