// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/step_prior.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/math/se3.h"
#include "kinemark/model/state.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr std::array<double, 4> kSlope = {-1.0, 3.0, -3.0, 1.0};

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

Matrix3d inverse_right_jacobian(const Vector3d& d) {
  const Matrix3d cross = math::skew(d);
  const double angle = d.norm();
  // 1/a^2 - (1 + cos a) / (2 a sin a), by its series near 0.
  const double second =
      angle < 1e-2 ? 1.0 / 12.0 + angle * angle / 720.0
                   : 1.0 / (angle * angle) - (1.0 + std::cos(angle)) / (2.0 * angle * std::sin(angle));
  return Matrix3d::Identity() + 0.5 * cross + second * (cross * cross);
}

StepPrior::StepPrior(const model::Model& model, MatrixXd precision)
    : model_(model), precision_(std::move(precision)), plain_(at(model.speed_count()), 1) {
  check(precision_.rows() == model.speed_count() && precision_.cols() == model.speed_count() &&
            (precision_.diagonal().array() > 0.0).all(),
        "need a positive step precision for every speed");
  for (const auto& free : model.free_joints())
    for (int i = 3; i < 6; ++i) plain_[at(free.speed_idx + i)] = 0;
  for (auto& d : d_) d.setZero(model.speed_count());
  e_.setZero(model.speed_count());
  rotation_.resize(model.free_joints().size());
}

double StepPrior::visit(const VectorXd& x0, const VectorXd& x1, const VectorXd& x2, const VectorXd& x3) {
  model::difference(model_, x0, x1, d_[0]);
  model::difference(model_, x1, x2, d_[1]);
  model::difference(model_, x2, x3, d_[2]);
  e_ = d_[2] - 2.0 * d_[1] + d_[0];
  for (std::size_t j = 0; j < rotation_.size(); ++j) {
    const int speed = model_.free_joints()[j].speed_idx + 3;
    std::array<Matrix3d, 3> R;
    for (std::size_t i = 0; i < 3; ++i) R[i] = inverse_right_jacobian(d_[i].segment<3>(speed));
    rotation_[j][0] = -R[0].transpose();
    rotation_[j][1] = R[0] + 2.0 * R[1].transpose();
    rotation_[j][2] = -2.0 * R[1] - R[2].transpose();
    rotation_[j][3] = R[2];
  }
  weighed_.noalias() = precision_ * e_;
  return 0.5 * e_.dot(weighed_);
}

void StepPrior::add_gradient(int a, Eigen::Ref<VectorXd> g) const {
  for (Index i = 0; i < e_.size(); ++i)
    if (plain_[at(i)]) g[i] += kSlope[at(a)] * weighed_[i];
  for (std::size_t j = 0; j < rotation_.size(); ++j) {
    const int speed = model_.free_joints()[j].speed_idx + 3;
    g.segment<3>(speed) += rotation_[j][at(a)].transpose() * weighed_.segment<3>(speed);
  }
}

void StepPrior::add_to(Window& window) {
  const Index n = e_.size();
  auto& M = window.matrix();
  for (Index b = 0; b < 4; ++b) {
    sloped_ = kSlope[at(b)] * precision_;
    for (std::size_t j = 0; j < rotation_.size(); ++j) {
      const int speed = model_.free_joints()[j].speed_idx + 3;
      sloped_.middleCols<3>(speed) = precision_.middleCols<3>(speed) * rotation_[j][at(b)];
    }
    for (Index a = b; a < 4; ++a) {
      M.block(a * n, b * n, n, n) += kSlope[at(a)] * sloped_;
      for (std::size_t j = 0; j < rotation_.size(); ++j) {
        const int speed = model_.free_joints()[j].speed_idx + 3;
        const Matrix3d beyond = rotation_[j][at(a)].transpose() - kSlope[at(a)] * Matrix3d::Identity();
        M.block(a * n + speed, b * n, 3, n) += beyond * sloped_.middleRows<3>(speed);
      }
    }
  }
}

}  // namespace kinemark::motion::internal
