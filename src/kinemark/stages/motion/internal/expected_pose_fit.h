// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The pose of one frame from where markers lay on their bodies a frame before, and which of its samples
// cannot be brought to agree with that pose. Statistic: docs/theory/inverse-kinematics.md, "Judging samples".
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {

/// What is expected of a frame before it is seen.
struct Expectation {
  Eigen::VectorXd x;            ///< state
  Eigen::VectorXd speed_sd;     ///< nv: of the state, one standard deviation
  Eigen::Matrix3Xd position;    ///< 3 x M: of each marker on its body, m in its axes (ground: the world's)
  Eigen::VectorXd position_sd;  ///< M: per axis, m; infinite where nothing is known of the marker
  Eigen::VectorXd bound;        ///< M: distance in standard deviations beyond which its sample is not taken
};

/// Robust fit of a pose to an expectation and a frame. Allocates in its constructor only.
class ExpectedPoseFit {
 public:
  explicit ExpectedPoseFit(const Problem& problem);

  /// Fit, and compare every sample with what all others together expect of it. Samples beyond
  /// their bound are not taken into the pose.
  void solve(const Expectation& expected, const Eigen::Matrix3Xd& y, const Eigen::VectorXd& seen);

  /// Per speed: 1 / variance that samples of the markers in `seen` give it in the expected pose, all other
  /// speeds being as uncertain as expected; infinite where a speed is fixed. solve() must come after it anew.
  [[nodiscard]] Eigen::VectorXd information(const Expectation& expected, const Eigen::VectorXd& seen);

  /// Pose that the samples that were taken agree on.
  [[nodiscard]] const Eigen::VectorXd& x() const { return x_; }
  /// Variance of x(), per speed: what the samples that were taken, and the expectation, leave open.
  [[nodiscard]] const Eigen::VectorXd& variance() const { return variance_; }
  /// Per marker: distance from what is expected, in its standard deviations; 0 where not seen or not known.
  [[nodiscard]] const Eigen::VectorXd& distance() const { return distance_; }
  /// Per marker: the same in m.
  [[nodiscard]] const Eigen::VectorXd& length() const { return length_; }
  /// Per marker: 1 when seen and not taken.
  [[nodiscard]] const std::vector<std::uint8_t>& rejected() const { return rejected_; }
  /// Kinematics at x().
  [[nodiscard]] model::Workspace& workspace() { return w_; }

 private:
  void visit(const Expectation& expected);
  /// Normal equations with the present weights, H_ factorised.
  void build(const Expectation& expected);
  /// One step with the present weights; its largest change.
  double step(const Expectation& expected);
  /// variance_ of what H_ was built from.
  void find_variance();

  const Problem& problem_;
  model::Workspace w_;
  Eigen::Matrix3Xd residual_;
  Eigen::VectorXd x_, moved_, weight_, g_, distance_, length_, variance_;
  Eigen::MatrixXd H_, C_;
  Eigen::VectorXd gap_;
  Eigen::Matrix<double, 3, Eigen::Dynamic> J_;
  Eigen::MatrixXd KJ_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
  std::vector<std::uint8_t> rejected_;
  std::vector<double> sorted_;
};

}  // namespace kinemark::motion::internal
