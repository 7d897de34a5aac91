// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Prior of white third differences of the posture, which couples four neighbouring frames.
//
// With d_j = difference(x_j, x_j+1), e = d_2 - 2 d_1 + d_0 is dt^3 times the jerk of every speed (for free
// joints that of the body's own angular velocity); prior: e white in time with a covariance S. Its slopes by
// small motions of the four postures are (-1, 3, -3, 1), for the rotation of a free joint the 3 x 3 matrices
// (-L_0, R_0 + 2 L_1, -2 R_1 - L_2, R_2), R and L the inverse right and left Jacobians of SO(3) at d_j.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

#include "kinemark/model/model.h"

namespace kinemark::motion::internal {

/// Prior SD over a span of frames, rad or m, of a speed that nothing determines.
inline constexpr double kFloorSd = 30.0;

// Block elimination of a long trajectory in a window of four frames.
//
// The normal equations of the whole recording have n x n blocks, coupled over three neighbours. Node by node
// the oldest of four is eliminated (Cholesky), which leaves a Schur complement on the other three: what a
// Kalman filter in information form carries. Going back through the factors gives the smoothed step, and the
// inverse within the band. About n^3 (1/6 + 3/2 + 9/2) products per frame, and 14 n^3 for the covariances.

/// Factors of one eliminated node for the backward pass.
struct NodeFactor {
  Eigen::MatrixXd L;  ///< n x n lower
  Eigen::MatrixXd Y;  ///< 3n x n: couplings to the next three nodes times L^-T
  Eigen::VectorXd y;  ///< n: L^-1 of the right-hand side
};

class Window {
 public:
  explicit Window(Eigen::Index n);

  void clear();
  /// Lower triangle of the 4n x 4n matrix and the right-hand side of the nodes in view, oldest first.
  [[nodiscard]] Eigen::MatrixXd& matrix() { return M_; }
  [[nodiscard]] Eigen::VectorXd& right() { return r_; }
  /// Add a symmetric matrix (lower triangle read) and a right-hand side to one of the four slots.
  void add(int slot, const Eigen::MatrixXd& H, const Eigen::VectorXd& right);
  /// Eliminate the oldest node and move on by one. Unknowns marked in `held` (n) do not move.
  void eliminate(const std::uint8_t* held, NodeFactor& factor);

 private:
  Eigen::Index n_;
  Eigen::MatrixXd M_;
  Eigen::VectorXd r_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
};

/// Step of a node from those of the next three (3n), by its factor.
void step_back(const NodeFactor& factor, const Eigen::VectorXd& next, Eigen::VectorXd& step);

/// Covariances in the backward pass. Holds that of the three nodes after the next one (3n x 3n).
class CovarianceWindow {
 public:
  explicit CovarianceWindow(Eigen::Index n);
  /// Move back by one node: afterwards matrix() belongs to that node and the next two.
  void step_back(const NodeFactor& factor);
  [[nodiscard]] const Eigen::MatrixXd& matrix() const { return C_; }

 private:
  Eigen::Index n_;
  Eigen::MatrixXd C_, gain_, cross_, own_;
};

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
