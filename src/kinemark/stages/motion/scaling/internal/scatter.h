// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Motion of the joints as opposed to the scatter of angles estimated from noisy markers.
//
// The information on a length grows with the sum of the squared angles of its joints. With postures estimated
// from noisy markers this sum counts noise as motion: even a limb at rest seems to determine its length.
// Postures shrunk towards their mean, so that their scatter equals the motion of the joints, give the
// information without this bias. Theory: docs/theory/scaling.md
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/scaling/internal/schur.h"

namespace kinemark::motion::internal {

/// Variances of the postures per unit variance of the marker noise: speeds x frames, diagonal of the inverse
/// of each frame's Jq'W Jq. Locked speeds: 0. Frames without markers: infinity.
[[nodiscard]] Eigen::MatrixXd posture_variances(const Problem& problem, const GeometryLayout& layout,
                                                const data::Trajectories& markers,
                                                const Eigen::MatrixXd& states, int threads);

/// Mean of a joint angle and the share (0 to 1) of its scatter about it that is motion, as a factor of
/// angles. Samples without information (variance not below 1) do not count.
struct Scatter {
  double mean = 0.0;
  double motion = 1.0;  ///< 1 where fewer than two samples count
};

/// The angles' chi-square about their weighted mean is 1 per degree of freedom when the joint keeps still,
/// 1 + motion/noise otherwise: motion = sqrt(1 - 1/chi-square), and 0 where the chi-square is within three
/// standard deviations of its expectation for a joint at rest.
[[nodiscard]] Scatter measure_scatter(const Eigen::VectorXd& angles, const Eigen::VectorXd& variances);

/// Shrinks the coordinates of every joint towards their mean to the scatter of its motion. Free joints, whose
/// pose has no information on the geometry, are left unchanged.
class Quiet {
 public:
  Quiet() = default;  ///< leaves everything as it is
  [[nodiscard]] static Quiet measure(const Problem& problem, const GeometryLayout& layout,
                                     const data::Trajectories& markers, const Eigen::MatrixXd& states,
                                     double noise_sd_m, int threads);

  /// The means are those of these states, the factors those measured.
  [[nodiscard]] Eigen::MatrixXd apply(const Problem& problem, const Eigen::MatrixXd& states) const;

  /// Per coordinate of the model, as Scatter::motion.
  [[nodiscard]] const Eigen::VectorXd& motion() const { return motion_; }

 private:
  Eigen::MatrixXd variances_;
  Eigen::VectorXd motion_;
};

}  // namespace kinemark::motion::internal
