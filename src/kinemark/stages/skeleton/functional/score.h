// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/stages/skeleton/functional/joint_fit.h"
#include "kinemark/stages/skeleton/functional/relative_motion.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton {

/// Normal equations of o_a + R_a p_a = o_b + R_b p_b, added up over frames.
struct ScoreSums {
  Matrix6 normal = Matrix6::Zero();  ///< of the frames' rotations, weighted
  Vector6 right = Vector6::Zero();   ///< right-hand side, m
  double squares = 0.0;              ///< of o_b - o_a, m^2
  double frames = 0.0;               ///< number of frames, as a weight

  /// One frame, with weights (3 x 3, symmetric) of the gap's components in world.
  void add(const SegmentPoses& a, const SegmentPoses& b, std::int64_t frame, const Eigen::Matrix3d& weight);
  /// One frame with weight 1.
  void add(const SegmentPoses& a, const SegmentPoses& b, std::int64_t frame);
  ScoreSums& operator-=(const ScoreSums& other);  ///< takes frames out
  ScoreSums& operator+=(const ScoreSums& other);  ///< adds the frames of another
  /// Sum of squares left at p.
  [[nodiscard]] double cost(const Vector6& p) const;
};

/// Symmetrical centre of rotation estimation (SCoRE; Ehrig, Taylor, Duda & Heller 2006, J Biomech 39:2798)
/// for a ball joint, symmetrical axis of rotation analysis (SARA; the same authors 2007, J Biomech 40:2150)
/// for a hinge: the axis is the direction that the same equations do not fix, and the centre the point on it
/// nearest to the markers of both segments.
///
/// The covariance comes from leaving out one block of frames at a time, plus what motion and noise of the
/// poses leave open (data::kJointPriorSd_m): by how much such frames, drawn anew, would differ. Errors that
/// repeat themselves in every movement are not in it: widen_by_skin(). Frames: those of motion.frames. Fewer
/// than 4: nothing is known.
[[nodiscard]] JointFit fit_score(const Samples& samples, const SegmentPoses& parent,
                                 const SegmentPoses& child, const RelativeMotion& motion,
                                 data::JointKind kind);

}  // namespace kinemark::skeleton
