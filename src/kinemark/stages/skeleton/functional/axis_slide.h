// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What skin that turns with a hinge's angle does to its axis. Theory: docs/theory/joint-centres-skin.md
#pragma once

#include <Eigen/Core>

#include "kinemark/stages/skeleton/functional/relative_motion.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"
#include "kinemark/stages/skeleton/functional/skin_prior.h"

namespace kinemark::skeleton {

/// Covariance (rad^2, in the parent's axes) of the direction of a hinge's axis by skin that turns the
/// segments' markers with the posture: a turn in proportion to the hinge's angle tilts the axis and leaves no
/// trace. How the markers' shape changes with the angle is seen; the markers as one body move with four times
/// that energy (rigid 80 %, deforming 20 % of skin motion; Barre et al. 2013, IEEE Trans Biomed Eng 60:3131).
/// The prior joins in as `prior.turn_weight` numbers beside those of the shape (three a marker less six for a
/// pose). Zero with fewer than 40 frames.
[[nodiscard]] Eigen::Matrix3d axis_slide_covariance(const Samples& samples, const SegmentPoses& parent,
                                                    const SegmentPoses& child, const RelativeMotion& motion,
                                                    const Eigen::Vector3d& axis_in_parent,
                                                    const SkinPrior& prior = {});

}  // namespace kinemark::skeleton
