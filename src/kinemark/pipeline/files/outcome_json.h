// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What jobs of pipeline/files and pipeline/simulate print with --json; the other jobs have a file of their
// own.
#pragma once

#include <nlohmann/json.hpp>

#include "kinemark/pipeline/files/recover_job.h"
#include "kinemark/pipeline/files/validate_job.h"

namespace kinemark::pipeline {

/// "written" (paths) and "warnings": all that there is to tell of a job that only writes files.
[[nodiscard]] nlohmann::ordered_json outcome_json(const JobOutcome& outcome);

/// A list with an entry for each file: "file", "exit_status", and "warnings", or "error" where it cannot be
/// read.
[[nodiscard]] nlohmann::ordered_json validate_json(const ValidateOutcome& outcome);

/// "original", "written", "messages" (kept), "end" (of the original: closed, open, cut, damaged),
/// "bytes_left_out", "damage" (a list of offset, bytes, what) and "warnings".
[[nodiscard]] nlohmann::ordered_json recover_json(const RecoverOutcome& outcome);

}  // namespace kinemark::pipeline
