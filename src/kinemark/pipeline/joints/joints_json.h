// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/data/skeleton.h"
#include "kinemark/pipeline/joints/joints_job.h"

namespace kinemark::pipeline {

/// HTML of the joints that were found: what stands out, the skeleton in space among the markers that it comes
/// from, centres, axes and lengths with their intervals.
/// @param first_frame  number of the recording's first frame
[[nodiscard]] std::string joints_page(const JointsJob& job, const JointsOutcome& outcome,
                                      std::int64_t first_frame);

/// What skeleton.json holds: skeleton_json(), how it was found ("version", "command", "input", "method",
/// "notes", "left_out", "next_step" where something was, "slips", "marker_noise" with soft tissue) and
/// "topology" where the data gave the segments.
[[nodiscard]] nlohmann::ordered_json joints_json(const JointsJob& job, const JointsOutcome& outcome);

/// A skeleton without its frames as JSON (SI units, degrees where a name says so); unknown numbers are null.
[[nodiscard]] nlohmann::ordered_json skeleton_json(const data::Skeleton& skeleton);

/// One line a joint for people: name, method, frames, words.
[[nodiscard]] std::vector<std::string> skeleton_description(const data::Skeleton& skeleton);

}  // namespace kinemark::pipeline
