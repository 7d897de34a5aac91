// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A search for joints without named segments: the segmentation, and what of its joints is known in the end.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/pipeline/joints/joints_job.h"

namespace kinemark::pipeline {

/// Segments by the names of known marker sets, else by the data; fills outcome.segmentation, and
/// outcome.topology where the data give them. Code::bad_input where too little was seen or nothing moved.
[[nodiscard]] Result<data::SegmentLayout> find_segmentation(const JointsJob& job,
                                                            const data::Trajectories& markers,
                                                            JointsOutcome& outcome);

/// After the estimate: what rivals disagree by goes into the covariances of outcome.skeleton; a joint that no
/// method placed, or that is known worse than the segmentation's bound, is taken out of the skeleton and is
/// not known; a gate for each joint that is not, and the words of the segmentation before all others. Without
/// a segmentation nothing is done.
void settle_segmentation(JointsOutcome& outcome);

/// "segmentation" of skeleton.json: where it comes from, the joints that are not determined, rivals.
[[nodiscard]] nlohmann::ordered_json segmentation_json(const JointsOutcome& outcome);

/// A skeleton without some of its joints, and without the segments that no joint is left of.
[[nodiscard]] data::Skeleton keep_joints(const data::Skeleton& skeleton,
                                         const std::vector<std::uint8_t>& keep);

}  // namespace kinemark::pipeline
