// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/window.h"

#include <algorithm>

#include "kinemark/core/check.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

Window::Window(Index n) : n_(n), M_(MatrixXd::Zero(4 * n, 4 * n)), r_(VectorXd::Zero(4 * n)), llt_(n) {}

void Window::clear() {
  M_.setZero();
  r_.setZero();
}

void Window::add(int slot, const MatrixXd& H, const VectorXd& right) {
  const Index first = slot * n_;
  M_.block(first, first, n_, n_).triangularView<Eigen::Lower>() += H;
  r_.segment(first, n_) += right;
}

void Window::eliminate(const std::uint8_t* held, NodeFactor& factor) {
  const Index n = n_;
  for (Index i = 0; held && i < n; ++i) {
    if (!held[i]) continue;
    M_.row(i).head(i).setZero();
    M_.col(i).tail(4 * n - i).setZero();
    M_(i, i) = 1.0;
    r_[i] = 0.0;
  }
  auto own = M_.topLeftCorner(n, n);
  llt_.compute(own);
  // Only the last nodes can fail, in undetermined directions whose pivots are negative by rounding.
  for (double floor = 1e-12; llt_.info() != Eigen::Success; floor *= 10.0) {
    check(floor < 1e6, "the normal equations hold numbers that are not finite");
    own.diagonal().array() += floor * std::max(1.0, own.diagonal().cwiseAbs().maxCoeff());
    llt_.compute(own);
  }
  factor.L = llt_.matrixL();
  factor.Y = M_.block(n, 0, 3 * n, n);
  factor.L.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(factor.Y);
  factor.y = r_.head(n);
  factor.L.triangularView<Eigen::Lower>().solveInPlace(factor.y);
  M_.bottomRightCorner(3 * n, 3 * n).selfadjointView<Eigen::Lower>().rankUpdate(factor.Y, -1.0);
  r_.tail(3 * n).noalias() -= factor.Y * factor.y;
  for (Index j = 0; j < 3 * n; ++j) {  // move up and left; columns come before the ones they are taken from
    M_.col(j).segment(j, 3 * n - j) = M_.col(n + j).segment(n + j, 3 * n - j);
    M_.col(j).tail(n).setZero();
  }
  M_.rightCols(n).setZero();
  r_.head(3 * n) = r_.tail(3 * n).eval();
  r_.tail(n).setZero();
}

void step_back(const NodeFactor& factor, const VectorXd& next, VectorXd& step) {
  step = factor.y;
  step.noalias() -= factor.Y.transpose() * next;
  factor.L.transpose().triangularView<Eigen::Upper>().solveInPlace(step);
}

CovarianceWindow::CovarianceWindow(Index n) : n_(n), C_(MatrixXd::Zero(3 * n, 3 * n)) {}

void CovarianceWindow::step_back(const NodeFactor& factor) {
  const Index n = n_;
  gain_ = -factor.Y.transpose();
  factor.L.transpose().triangularView<Eigen::Upper>().solveInPlace(gain_);
  cross_.noalias() = gain_ * C_;
  own_.setIdentity(n, n);
  factor.L.triangularView<Eigen::Lower>().solveInPlace(own_);
  factor.L.transpose().triangularView<Eigen::Upper>().solveInPlace(own_);
  own_.noalias() += cross_ * gain_.transpose();
  for (Index j = 2 * n; j-- > 0;)  // move down and right; rows and columns after the ones they are taken from
    C_.col(n + j).segment(n, 2 * n) = C_.col(j).head(2 * n);
  C_.topLeftCorner(n, n) = 0.5 * (own_ + own_.transpose());
  C_.topRightCorner(n, 2 * n) = cross_.leftCols(2 * n);
  C_.bottomLeftCorner(2 * n, n) = cross_.leftCols(2 * n).transpose();
}

}  // namespace kinemark::motion::internal
