// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kinemark/pipeline/files/many.h"
#include "kinemark/pipeline/files/validate_job.h"

namespace kinemark::pipeline {

/// Cells below each other: columns of one width, the last one ragged, two blanks between them.
/// @param rows  all with as many cells
[[nodiscard]] std::string aligned(const std::vector<std::vector<std::string>>& rows);

/// What many files hold, for people: a heading, a line for each file (name, format, markers or columns,
/// frames or rows, rate, seconds, and "good", its first finding, or why it cannot be read), and the totals.
[[nodiscard]] std::string file_table(const ValidateOutcome& outcome);

/// The same as an array: info_json() of each file that can be read, else its "file", "exit_status" and
/// "error".
[[nodiscard]] nlohmann::ordered_json files_json(const ValidateOutcome& outcome);

/// How many recordings fared: a heading, a line for each (input, status, seconds, output, what was said), and
/// how many fared how.
[[nodiscard]] std::string trial_table(const ManyOutcome& outcome);

/// The same: "exit_status" and "trials", each with "input", "output", "status", "exit_status", "seconds",
/// "warnings" (their number) and "said".
[[nodiscard]] nlohmann::ordered_json trials_json(const ManyOutcome& outcome);

}  // namespace kinemark::pipeline
