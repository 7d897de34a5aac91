// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What is said of a run beside the account that the verb gives.
#pragma once

#include "kinemark/pipeline/clean/clean_job.h"

namespace kinemark::pipeline::internal {

/// What was asked of a run, for the record.
[[nodiscard]] report::CleanRun describe_run(const CleanJob& job, const data::Trial& trial);

}  // namespace kinemark::pipeline::internal
