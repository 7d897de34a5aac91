// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kinemark/data/trial.h"
#include "kinemark/pipeline/joints/joints_job.h"

namespace kinemark::pipeline {

/// HTML of the joints that were found: what stands out, the skeleton in space among the markers that it comes
/// from, centres, axes and lengths with their intervals.
/// @param trial  the recording, as it was used
[[nodiscard]] std::string joints_page(const JointsJob& job, const JointsOutcome& outcome,
                                      const data::Trial& trial);

}  // namespace kinemark::pipeline
