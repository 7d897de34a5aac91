// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "kinemark/pipeline/joints/joints_job.h"

namespace kinemark::pipeline {

/// HTML of the joints that were found: what stands out, the skeleton in space among the markers that it comes
/// from, centres, axes and lengths with their intervals.
/// @param first_frame  number of the recording's first frame
[[nodiscard]] std::string joints_page(const JointsJob& job, const JointsOutcome& outcome,
                                      std::int64_t first_frame);

}  // namespace kinemark::pipeline
