// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What skin that turns with a hinge's angle does to its axis. Theory: docs/theory/joint-centres-skin.md
#pragma once

#include <Eigen/Core>

#include "kinemark/stages/skeleton/functional/internal/cluster.h"
#include "kinemark/stages/skeleton/functional/internal/posture.h"
#include "kinemark/stages/skeleton/functional/joint_fit.h"
#include "kinemark/stages/skeleton/functional/relative_motion.h"

namespace kinemark::skeleton::internal {

/// Slides of one segment's markers that turn them as one body.
struct TurningSlide {
  const Cluster& cluster;
  double own_m = 0.0;   ///< of each marker by itself, per axis, m per rad
  double turn_m = 0.0;  ///< of all as one body, at their radius, m per rad
};

/// Covariance (rad^2, in the parent's axes) of the direction of a hinge's axis. A turn of a segment's markers
/// in proportion to the hinge's angle tilts the axis by as much and leaves no trace: that of each marker's
/// own slide, and that of the slide as one body, on either segment; and what scatters of the rotation about
/// other axes, with frames that are alike counted as one. Nothing along the axis.
[[nodiscard]] Eigen::Matrix3d axis_slide_covariance(const TurningSlide& parent, const TurningSlide& child,
                                                    const RelativeMotion& motion, const Posture& posture,
                                                    const JointFit& hinge);

}  // namespace kinemark::skeleton::internal
