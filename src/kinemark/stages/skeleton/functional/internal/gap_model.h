// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/stages/skeleton/functional/internal/cluster.h"
#include "kinemark/stages/skeleton/functional/internal/own_slide.h"
#include "kinemark/stages/skeleton/functional/internal/posture.h"
#include "kinemark/stages/skeleton/functional/joint_fit.h"

namespace kinemark::skeleton::internal {

/// Coefficients of the gap: the joint in both segments, the slide of its place in the parent's axes by every
/// posture term, and by the linear ones in the child's.
inline constexpr int kGapSize = 6 + 3 * kPostureTerms + 3 * kLinearTerms;

/// The gap between the two places of a joint, o_b - o_a in the parent's axes less X about, as linear in its
/// change and in slides. The rotation in it is that of the smoothed posture: one with the noise of the poses
/// lets the joint run to the markers, where this noise has no lever.
struct GapModel {
  Vector6 about = Vector6::Zero();  ///< the joint where it is linearised, m
  Posture posture;
  Eigen::MatrixXd design;     ///< 3F x kGapSize
  Eigen::VectorXd gap;        ///< 3F, m
  Eigen::MatrixXd blocks;     ///< 3B x kGapSize: means over posture.block frames
  Eigen::VectorXd block_gap;  ///< 3B

  /// Gap that coefficients leave, F x 3.
  [[nodiscard]] Eigen::MatrixXd residual(const Eigen::VectorXd& coefficients) const;
};

[[nodiscard]] GapModel gap_model(const SegmentPoses& parent, const SegmentPoses& child,
                                 const RelativeMotion& motion, const Posture& posture);

}  // namespace kinemark::skeleton::internal
