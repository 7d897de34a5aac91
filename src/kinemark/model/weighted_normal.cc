// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/model/weighted_normal.h"

#include "kinemark/core/index.h"
#include "kinemark/model/internal/composite.h"

namespace kinemark::model {
namespace {}  // namespace

void marker_normal_matrix(const Model& model, Workspace& w, const VectorXd& weight, Eigen::MatrixXd& H) {
  for (auto& inertia : w.composite) {
    inertia.mass = 0.0;
    inertia.first.setZero();
    inertia.second.setZero();
  }
  for (int m = 0; m < model.marker_count(); ++m) {
    const int body = model.markers()[at(m)].body;
    if (body < 0 || weight[m] == 0.0) continue;
    const Vector3d p = w.marker.col(m);
    SpatialInertia& inertia = w.composite[at(body)];
    inertia.mass += weight[m];
    inertia.first += weight[m] * p;
    inertia.second.noalias() -= (weight[m] * p) * p.transpose();
    inertia.second.diagonal().array() += weight[m] * p.squaredNorm();
  }
  internal::project_composites(model, w, H);
}

void clear_forces(Workspace& w) {
  for (std::size_t b = 0; b < w.force.size(); ++b) {
    w.force[b] = {Vector3d::Zero(), Vector3d::Zero()};
    w.moment[b].setZero();
  }
}

void add_force(Workspace& w, int body, const Vector3d& x_in_world, const Vector3d& force) {
  if (body < 0) return;
  w.force[at(body)].w += x_in_world.cross(force);
  w.force[at(body)].v += force;
  w.moment[at(body)].noalias() += x_in_world * force.transpose();
}

void add_marker_forces(const Model& model, Workspace& w, const VectorXd& weight,
                       const Eigen::Matrix3Xd& residual) {
  for (int m = 0; m < model.marker_count(); ++m)
    if (weight[m] != 0.0)
      add_force(w, model.markers()[at(m)].body, w.marker.col(m), weight[m] * residual.col(m));
}

void project_forces(const Model& model, Workspace& w, VectorXd& g) { internal::project_forces(model, w, g); }

void subtract_force_curvature(const Model& model, Workspace& w, Eigen::MatrixXd& H) {
  const auto bodies = model.bodies();
  const auto columns = model.columns();
  for (int b = static_cast<int>(bodies.size()) - 1; b >= 0; --b) {
    const Model::Body& body = bodies[at(b)];
    const Vector3d F = w.force[at(b)].v, T = w.force[at(b)].w;
    const Matrix3d A = w.moment[at(b)];
    if (body.parent >= 0) w.moment[at(body.parent)] += A;
    const double trace = A.trace();
    const auto moment_of = [&](const Spatial& s) -> Vector3d { return s.v.cross(F) + A * s.w - trace * s.w; };
    const auto subtract = [&](int row, int col, double h) {
      H(row, col) -= h;
      H(col, row) -= h;
    };

    // Joints above this one: rigid motion fields, one term per pair of columns.
    const auto above = body.support.size() - static_cast<std::size_t>(body.last_column - body.first_column);
    for (int d = body.first_column; d < body.last_column; ++d) {
      const Vector3d t = moment_of(w.column[at(d)]);
      for (std::size_t i = 0; i < above; ++i) {
        const int c = body.support[i];
        subtract(columns[at(c)].speed, columns[at(d)].speed, w.column[at(c)].w.dot(t));
      }
    }

    // Within the joint.
    if (body.free_joint >= 0) {
      for (int d = body.first_column + 3; d < body.last_column; ++d) {
        const Vector3d t = moment_of(w.column[at(d)]);
        for (int c = body.first_column + 3; c < body.last_column; ++c)
          subtract(columns[at(c)].speed, columns[at(d)].speed, 0.5 * w.column[at(c)].w.dot(t));
      }
      continue;
    }
    for (int l = body.first_primitive; l < body.last_primitive; ++l) {
      const auto& late = model.primitives()[at(l)];
      const Spatial& s = w.primitive[at(l)];
      const Vector3d t = moment_of(s);
      const double push = s.v.dot(F) + s.w.dot(T);
      const int late_speed[2] = {late.column >= 0 ? columns[at(late.column)].speed : -1,
                                 late.second_column >= 0 ? columns[at(late.second_column)].speed : -1};
      const double late_slope[2] = {w.slope[at(l)], w.second_slope[at(l)]};
      for (int k = body.first_primitive; k < l; ++k) {
        const auto& early = model.primitives()[at(k)];
        if (!early.is_rotation) continue;
        const double h = w.primitive[at(k)].w.dot(t);
        const int early_speed[2] = {early.column >= 0 ? columns[at(early.column)].speed : -1,
                                    early.second_column >= 0 ? columns[at(early.second_column)].speed : -1};
        const double early_slope[2] = {w.slope[at(k)], w.second_slope[at(k)]};
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j)
            if (early_speed[i] >= 0 && late_speed[j] >= 0)
              subtract(early_speed[i], late_speed[j], early_slope[i] * late_slope[j] * h);
      }
      // The primitive with itself: its motion rotates its own force field, and its value has a second
      // derivative.
      const double own = s.w.dot(t);
      const double curvature[2] = {w.curvature[at(l)], w.second_curvature[at(l)]};
      for (int i = 0; i < 2; ++i)
        if (late_speed[i] >= 0)
          H(late_speed[i], late_speed[i]) -= late_slope[i] * late_slope[i] * own + curvature[i] * push;
      if (late_speed[0] >= 0 && late_speed[1] >= 0)
        subtract(late_speed[0], late_speed[1],
                 late_slope[0] * late_slope[1] * own + w.cross_curvature[at(l)] * push);
    }
  }
}

}  // namespace kinemark::model
