// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/step_prior.h"

#include <cmath>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/math/se3.h"
#include "kinemark/model/state.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr std::array<double, 4> kSlope = {-1.0, 3.0, -3.0, 1.0};

}  // namespace

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
