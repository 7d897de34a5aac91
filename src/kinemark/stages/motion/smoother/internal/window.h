// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Block elimination of a long trajectory in a window of four frames.
//
// The normal equations of the whole recording have n x n blocks, coupled over three neighbours. Node by node
// the oldest of four is eliminated (Cholesky), which leaves a Schur complement on the other three: what a
// Kalman filter in information form carries. Going back through the factors gives the smoothed step, and the
// inverse within the band. About n^3 (1/6 + 3/2 + 9/2) products per frame, and 14 n^3 for the covariances.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace kinemark::motion::internal {

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

}  // namespace kinemark::motion::internal
