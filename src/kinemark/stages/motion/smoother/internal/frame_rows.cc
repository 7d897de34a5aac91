// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/frame_rows.h"

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/weighted_normal.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kLoopInformation = 1e10;  // 1/m^2

}  // namespace

FrameRows::FrameRows(const model::Model& model) : model_(model), w_(model) {}

double FrameRows::visit(const Observations& observations, std::int64_t f, const Eigen::VectorXd& x) {
  model::kinematics(model_, w_, x);
  observations.linearize(f, w_.marker, seen_);
  double cost = seen_.cost;
  if (!model_.point_constraints().empty()) {
    model::point_constraint_gaps(model_, w_, gap_);
    cost += 0.5 * kLoopInformation * gap_.squaredNorm();
  }
  return cost;
}

void FrameRows::descent(Eigen::VectorXd& g) {
  model::clear_forces(w_);
  for (int m = 0; m < model_.marker_count(); ++m)
    model::add_force(w_, model_.markers()[at(m)].body, w_.marker.col(m), seen_.descent.col(m));
  model::project_forces(model_, w_, g);
  if (gap_.size() == 0) return;
  model::point_constraint_jacobian(model_, w_, C_);
  g.noalias() -= kLoopInformation * (C_.transpose() * gap_);
}

void FrameRows::matrix(Eigen::MatrixXd& H) {
  model::marker_normal_matrix(model_, w_, seen_.weight, H);
  for (std::size_t m = 0; m < seen_.full.size(); ++m) {
    const int body = model_.markers()[m].body;
    if (body < 0) continue;
    const Eigen::Matrix3d& information = seen_.full[m];
    if (information.isZero(0.0)) continue;
    const Eigen::Vector3d p = w_.marker.col(static_cast<Eigen::Index>(m));
    for (const int c : model_.bodies()[at(body)].support) {
      const auto& s = w_.column[at(c)];
      const Eigen::Vector3d weighed = information * (s.v + s.w.cross(p));
      const int row = model_.columns()[at(c)].speed;
      for (const int d : model_.bodies()[at(body)].support) {
        const auto& t = w_.column[at(d)];
        H(row, model_.columns()[at(d)].speed) += weighed.dot(t.v + t.w.cross(p));
      }
    }
  }
  if (gap_.size() == 0) return;
  model::point_constraint_jacobian(model_, w_, C_);
  H.noalias() += kLoopInformation * (C_.transpose() * C_);
}

}  // namespace kinemark::motion::internal
