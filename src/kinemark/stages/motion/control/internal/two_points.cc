// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/two_points.h"

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;

constexpr double kCoincide_m = 1e-9;  // nearer, the direction is undefined

}  // namespace

void add_point(const model::Model& model, const model::Workspace& w, const RidingPoint& point,
               const Vector3d& u, Eigen::MatrixXd& J) {
  if (point.body < 0) return;
  for (const int column : model.bodies()[at(point.body)].support) {
    const auto& s = w.column[at(column)];
    J(0, model.columns()[at(column)].speed) += u.dot(s.v + s.w.cross(point.x_in_world));
  }
}

LengthRates::LengthRates(const Vector3d& way, const Vector3d& rate, const Vector3d& rate_2) {
  const double length = way.norm();
  const Vector3d u = way / length;
  first = u.dot(rate);
  second = u.dot(rate_2) + (rate.squaredNorm() - first * first) / length;
}

double distance_row(const model::Model& model, const model::Workspace& w, const RidingPoint& a,
                    const RidingPoint& b, TaskRows& out) {
  const Vector3d way = a.x_in_world - b.x_in_world;
  const double distance = way.norm();
  if (distance < kCoincide_m) return 0.0;
  const LengthRates rates(
      way, model::point_velocity(w, a.body, a.x_in_world) - model::point_velocity(w, b.body, b.x_in_world),
      model::point_bias_acceleration(w, a.body, a.x_in_world) -
          model::point_bias_acceleration(w, b.body, b.x_in_world));
  out.velocity[0] = rates.first;
  out.bias[0] = rates.second;
  add_point(model, w, a, way / distance, out.jacobian);
  add_point(model, w, b, -way / distance, out.jacobian);
  return distance;
}

}  // namespace kinemark::motion::internal
