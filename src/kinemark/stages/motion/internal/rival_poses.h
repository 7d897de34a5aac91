// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Where few markers are seen, more than one pose fits them: a mirror pose. All of them are followed in time;
// the likeliest is taken, and what the others leave open is told. Theory: docs/theory/error-bars.md
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/stages/motion/internal/error_bars.h"
#include "kinemark/stages/motion/internal/frame_walk.h"
#include "kinemark/stages/motion/internal/loose_bodies.h"

namespace kinemark::motion::internal {

/// A pose that fits a frame about as well as the one that was taken.
struct RivalPose {
  std::int64_t frame = 0;
  Eigen::VectorXd state;
  double probability = 0.0;  ///< by its markers and by the frames before and behind
};

/// Look for rivals in all frames with a loose body, and put the likeliest pose of each frame into `solved`;
/// frames whose pose is another one then are solved as `markers` have them.
///
/// @param loose      of find_loose_frames()
/// @param walk       that solved them; its starts and losses are used
/// @param variances  of the markers' errors
/// @param changed    becomes 1 (F) where a frame got another pose
/// @return           the rivals that are left, by frame. Costs up to 32 solutions of a frame with a loose
///                   body every 50 to 200 ms, next to nothing in others.
[[nodiscard]] std::vector<RivalPose> choose_among_rivals(const Problem& problem, const IkOptions& options,
                                                         const data::Trajectories& markers,
                                                         const LooseFrames& loose,
                                                         const MarkerVariances& variances, FrameWalk& walk,
                                                         SolvedFrames& solved,
                                                         std::vector<std::uint8_t>& changed);

/// The deviation of each coordinate is wider by each rival's share. Where rivals that are not very improbable
/// differ in it by more than 0.03 rad (m) and two deviations, the coordinate is not determined.
void doubt_rivals(const Problem& problem, const std::vector<RivalPose>& rivals, data::JointMotion& motion);

}  // namespace kinemark::motion::internal
