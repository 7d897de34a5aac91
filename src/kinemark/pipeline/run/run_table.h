// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "kinemark/pipeline/run/run_job.h"

namespace kinemark::pipeline {

/// How the steps of a run fared: a heading, a line for each (subject, recording, step, status, seconds, what
/// was said), and how many fared how.
[[nodiscard]] std::string run_table(const RunOutcome& outcome);

/// The same: "exit_status" and "steps", each with "subject", "trial" (null: of the subject), "step",
/// "command", "outputs", "status", "exit_status", "seconds" and "said".
[[nodiscard]] nlohmann::ordered_json run_json(const RunOutcome& outcome);

/// The commands of a run, a line each, as they would be typed in a shell.
[[nodiscard]] std::string commands_text(const RunOutcome& outcome);

}  // namespace kinemark::pipeline
