// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Prior of white third differences of the posture, which couples four neighbouring frames.
//
// With d_j = difference(x_j, x_j+1), e = d_2 - 2 d_1 + d_0 is dt^3 times the jerk of every speed (for free
// joints that of the body's own angular velocity); prior: e white in time with a covariance S. Its slopes by
// small motions of the four postures are (-1, 3, -3, 1), for the rotation of a free joint the 3 x 3 matrices
// (-L_0, R_0 + 2 L_1, -2 R_1 - L_2, R_2), R and L the inverse right and left Jacobians of SO(3) at d_j.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "kinemark/model/model.h"
#include "kinemark/stages/motion/smoother/internal/window.h"

namespace kinemark::motion::internal {

class StepPrior {
 public:
  /// @param precision  nv x nv, inverse of the covariance of a third difference.
  StepPrior(const model::Model& model, Eigen::MatrixXd precision);

  [[nodiscard]] const Eigen::MatrixXd& precision() const { return precision_; }

  /// Four neighbouring postures; returns half of e' S^-1 e.
  double visit(const Eigen::VectorXd& x0, const Eigen::VectorXd& x1, const Eigen::VectorXd& x2,
               const Eigen::VectorXd& x3);
  /// At the last visit: gradient of that by the motion of posture a (0 to 3), added to g.
  void add_gradient(int a, Eigen::Ref<Eigen::VectorXd> g) const;
  /// At the last visit: second derivatives into the four slots.
  void add_to(Window& window);

 private:
  const model::Model& model_;
  Eigen::MatrixXd precision_;
  std::vector<std::uint8_t> plain_;  ///< per speed: slope is (-1, 3, -3, 1)
  std::array<Eigen::VectorXd, 3> d_;
  Eigen::VectorXd e_, weighed_;
  Eigen::MatrixXd sloped_;
  std::vector<std::array<Eigen::Matrix3d, 4>> rotation_;  ///< per free joint
};

/// Inverse of the right Jacobian of SO(3) at a rotation vector (below 180 deg).
[[nodiscard]] Eigen::Matrix3d inverse_right_jacobian(const Eigen::Vector3d& d);

}  // namespace kinemark::motion::internal
