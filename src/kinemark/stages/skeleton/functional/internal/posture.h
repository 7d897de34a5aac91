// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/stages/skeleton/functional/relative_motion.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton::internal {

/// Posture of a joint, the rotation of child against parent: F x 3 principal components, rad, largest first,
/// about their mean, in the frames that were drawn.
struct Posture {
  std::vector<std::int64_t> frames;                  ///< F, in order of time
  Eigen::MatrixX3d component;                        ///< F x 3, rad
  Eigen::Vector3d sd_rad = Eigen::Vector3d::Zero();  ///< of each component
};

/// Posture in at most 1,500 frames of motion.frames, evenly drawn.
[[nodiscard]] Posture posture_of(const SegmentPoses& parent, const SegmentPoses& child,
                                 const RelativeMotion& motion);

/// How many movements the frames hold: how often the first component goes from half an SD below its mean to
/// half an SD above. From 3 to 12: less is too little to tell how they differ.
[[nodiscard]] std::int64_t count_cycles(const Posture& posture);

}  // namespace kinemark::skeleton::internal
