// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A search for joints without named segments: the segmentation, and what of its joints is known in the end.
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/workflow/joints/joints.h"

namespace kinemark::workflow {

/// Segments by the names of known marker sets, else by the data; fills outcome.segmentation, and
/// outcome.topology where the data give them. Code::bad_input where too little was seen or nothing moved.
[[nodiscard]] Result<data::SegmentLayout> find_segmentation(const JointsOptions& options,
                                                            const data::Trajectories& markers,
                                                            JointsFound& outcome);

/// After the estimate: what rivals disagree by goes into the covariances of outcome.skeleton; a joint that no
/// method placed, or that is known worse than the segmentation's bound, is taken out of the skeleton and is
/// not known; a gate for each joint that is not, and the words of the segmentation before all others. Without
/// a segmentation nothing is done.
void settle_segmentation(JointsFound& outcome);

/// A skeleton without some of its joints, and without the segments that no joint is left of.
[[nodiscard]] data::Skeleton keep_joints(const data::Skeleton& skeleton,
                                         const std::vector<std::uint8_t>& keep);

}  // namespace kinemark::workflow
