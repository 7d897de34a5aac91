// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What skin that slides with the posture does to a joint: every cycle of a movement repeats the same error,
// so scatter alone does not show it. Theory: docs/theory/joint-centres-skin.md
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "kinemark/stages/skeleton/functional/joint_fit.h"
#include "kinemark/stages/skeleton/functional/relative_motion.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"
#include "kinemark/stages/skeleton/functional/skin_prior.h"

namespace kinemark::skeleton {

/// The error that sliding skin leaves in a joint that least squares of the gap between its two places found.
///
/// Posture is the rotation of child against parent from its mean, in its principal components. Under the
/// slide model each side's place of the joint moves by a random linear and quadratic function of the posture;
/// its size has a log-normal prior about half the gap seen, may be none, and is integrated out. Part of such
/// a function looks like a shift of the joint and cannot be seen; the part that can be seen tells how large
/// the other is.
struct SkinSlide {
  /// false: too few frames (40) to tell, or a gap of no more than rounding (0.1 um); all below is zero
  bool known = false;
  double share = 0.0;         ///< probability that there is any slide, 0 to 1
  double amplitude_m = 0.0;   ///< SD of the slide on an axis at one SD of the posture's first component
  double noise_sd_m = 0.0;    ///< of the gap about the slide, per axis
  double frames_alike = 1.0;  ///< frames that count as one, as errors of neighbours are alike
  Matrix6 covariance = Matrix6::Zero();  ///< of the joint in both segments: noise and slide, m^2
  /// By how much of that another part of the trial, with movements of its own, would differ (m^2): the same
  /// skin slides in it in the same way, so what the movements share is left out.
  Matrix6 repeatability = Matrix6::Zero();
};

/// @param solve   change of the joint (parent's axes, child's axes) with the right-hand side of the normal
/// equations
///                (ScoreSums): symmetric, without the directions that the motion leaves open
/// @param centre  the joint that least squares found, m
/// @param kind    of the joint: a hinge's gap shows the slide along its axis only, so the prior's figure
/// stands for
///                the gap as the median of the size
/// At most 1,500 frames, evenly drawn, are used. O(frames).
[[nodiscard]] SkinSlide measure_skin_slide(const SegmentPoses& parent, const SegmentPoses& child,
                                           const RelativeMotion& motion, const Matrix6& solve,
                                           const Vector6& centre,
                                           data::JointKind kind = data::JointKind::ball,
                                           const SkinPrior& prior = {});

}  // namespace kinemark::skeleton
