// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"

namespace kinemark::pipeline {

/// Make the page of a solved trial from the files that `kinemark ik` wrote: Q.mot (or Q_report.json) and what
/// lies beside it. The gap map shows the states of the recording when the file named in Q_report.json is
/// still there.
[[nodiscard]] Status write_report(const std::filesystem::path& solved, const std::filesystem::path& page,
                                  bool force);

}  // namespace kinemark::pipeline
