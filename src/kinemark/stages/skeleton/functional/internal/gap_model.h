// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What skin that slides with the posture does to a joint: to a hinge's axis, to the shape of its segments, to
// the gap between the two places of the joint. Theory: docs/theory/joint-centres-skin.md
#pragma once

#include <Eigen/Core>

#include <array>

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

/// How many frames count as one in a regression on `regressors` (F x k) whose errors (F x m) are alike from
/// frame to frame: 1 + 2 sum of the products of their autocorrelations, with Bartlett's weights, over up to
/// F / 4 and 200 frames; 1 at least. Where either repeats nothing, frames are independent.
[[nodiscard]] double frames_alike(const Eigen::MatrixXd& errors, const Eigen::MatrixXd& regressors);

/// Sizes that a marker's own slide may have, m per rad: none, and 19 from 0.15 to 80 mm.
inline constexpr int kSlideSizes = 20;
[[nodiscard]] const std::array<double, kSlideSizes>& slide_sizes();

/// Slides of single markers on their segment in proportion to the posture, as their shape shows them: the SD
/// of a coefficient of the linear terms, alike for all markers and axes.
struct OwnSlide {
  std::array<double, kSlideSizes> weight{};  ///< probability of each of slide_sizes(); none has 1/2 before
  double size_m = 0.0;                       ///< RMS over these, m per rad
  double limit_m = 0.0;                      ///< 95 % of the probability lies at or below it, m per rad
  double noise_variance = 0.0;               ///< of a marker, per axis, without the slides, m^2
  /// SD of the coefficients of quadratic (per rad) and of lag terms over that of linear ones, in bounds.
  double quadratic = 0.0, lag = 0.0;
};

/// @param deformation  F x 3M, see deformation()
/// @param freedom      3M - 6
[[nodiscard]] OwnSlide find_own_slide(const Eigen::MatrixXd& deformation, const Posture& posture,
                                      double freedom);

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
