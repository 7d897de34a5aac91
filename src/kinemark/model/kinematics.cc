// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/model/kinematics.h"

#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/core/index.h"

namespace kinemark::model {
namespace {

// Value of every coordinate with its first two derivatives by the one speed that moves it.
void evaluate_coordinates(const Model& model, Workspace& w, const VectorXd& x) {
  const auto coordinates = model.coordinates();
  for (const int c : model.coordinate_order()) {
    const auto& coordinate = coordinates[at(c)];
    if (coordinate.state_idx >= 0) {
      w.q[c] = x[coordinate.state_idx];
    } else if (coordinate.source >= 0) {
      const auto value = coordinate.coupling(w.q[coordinate.source]);
      const double slope = w.q_slope[coordinate.source];
      w.q[c] = value.f;
      w.q_slope[c] = value.df * slope;
      w.q_curvature[c] = value.ddf * slope * slope + value.df * w.q_curvature[coordinate.source];
    }
  }
}

// Value of a primitive; its derivatives by the speeds go to the workspace.
double evaluate_primitive(const Model::Primitive& primitive, int k, Workspace& w) {
  if (primitive.is_identity) {
    w.slope[at(k)] = w.q_slope[primitive.coordinate];
    w.curvature[at(k)] = w.q_curvature[primitive.coordinate];
    return w.q[primitive.coordinate];
  }
  const int c = primitive.coordinate, d = primitive.second_coordinate;
  const auto f = primitive.function(c >= 0 ? w.q[c] : 0.0);
  const double cs = c >= 0 ? w.q_slope[c] : 0.0, cc = c >= 0 ? w.q_curvature[c] : 0.0;
  if (d < 0) {
    w.slope[at(k)] = f.df * cs;
    w.curvature[at(k)] = f.ddf * cs * cs + f.df * cc;
    return f.f;
  }
  const auto g = primitive.second_function(w.q[d]);
  const double ds = w.q_slope[d], dc = w.q_curvature[d];
  w.slope[at(k)] = f.df * g.f * cs;
  w.second_slope[at(k)] = f.f * g.df * ds;
  w.curvature[at(k)] = (f.ddf * cs * cs + f.df * cc) * g.f;
  w.cross_curvature[at(k)] = f.df * g.df * cs * ds;
  w.second_curvature[at(k)] = f.f * (g.ddf * ds * ds + g.df * dc);
  return f.f * g.f;
}

// R <- R * rotation(axis, angle); only two columns change when the axis is a coordinate axis.
void rotate_by(Matrix3d& R, const Model::Primitive& primitive, double angle) {
  const double s = std::sin(angle), c = std::cos(angle);
  if (primitive.principal >= 0) {
    const int i = (primitive.principal + 1) % 3, j = (primitive.principal + 2) % 3;
    const double signed_s = primitive.axis[primitive.principal] * s;
    const Vector3d column = R.col(i);
    R.col(i) = c * column + signed_s * R.col(j);
    R.col(j) = c * R.col(j) - signed_s * column;
    return;
  }
  const Vector3d& a = primitive.axis;
  Matrix3d rotation;
  const double t = 1.0 - c;
  rotation << t * a.x() * a.x() + c, t * a.x() * a.y() - s * a.z(), t * a.x() * a.z() + s * a.y(),
      t * a.x() * a.y() + s * a.z(), t * a.y() * a.y() + c, t * a.y() * a.z() - s * a.x(),
      t * a.x() * a.z() - s * a.y(), t * a.y() * a.z() + s * a.x(), t * a.z() * a.z() + c;
  R = (R * rotation).eval();
}

}  // namespace

Workspace::Workspace(const Model& model) {
  const auto n = model.coordinate_count();
  const auto bodies = model.bodies().size(), primitives = model.primitives().size();
  q.setZero(n);
  for (int c = 0; c < n; ++c) q[c] = model.description().coordinates[at(c)].default_value;
  q_slope.setOnes(n);
  q_curvature.setZero(n);
  rotation.resize(bodies);
  position.resize(bodies);
  joint_rotation.resize(bodies);
  joint_out_rotation.resize(bodies);
  primitive.resize(primitives);
  for (auto* derivative : {&slope, &second_slope, &curvature, &cross_curvature, &second_curvature})
    derivative->assign(primitives, 0.0);
  column.resize(model.columns().size());
  marker.setZero(3, model.marker_count());
  v.setZero(model.speed_count());
  body_velocity.resize(bodies);
  body_bias.resize(bodies);
  inertia.resize(bodies);
  composite.resize(bodies);
  force.resize(bodies);
  moment.resize(bodies);
}

void kinematics(const Model& model, Workspace& w, const VectorXd& x) {
  evaluate_coordinates(model, w, x);
  const auto bodies = model.bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Model::Body& body = bodies[b];
    Matrix3d R = body.parent_from_joint.rotation;
    Vector3d p = body.parent_from_joint.translation;
    if (body.parent >= 0) {
      const Matrix3d& parent = w.rotation[at(body.parent)];
      p = w.position[at(body.parent)] + parent * p;
      if (body.plain_parent_rotation)
        R = parent;
      else
        R = parent * body.parent_from_joint.rotation;
    }
    w.joint_rotation[b] = R;

    if (body.free_joint >= 0) {
      const auto& free = model.free_joints()[at(body.free_joint)];
      const Matrix3d frame = R;
      p += frame * x.segment<3>(free.state_idx);
      const Eigen::Quaterniond rotation(x[free.state_idx + 3], x[free.state_idx + 4], x[free.state_idx + 5],
                                        x[free.state_idx + 6]);
      R = frame * rotation.toRotationMatrix();
      for (int i = 0; i < 3; ++i) {
        w.column[at(body.first_column + i)] = {Vector3d::Zero(), frame.col(i)};
        w.column[at(body.first_column + 3 + i)] = {R.col(i), p.cross(R.col(i))};
      }
    } else {
      for (int c = body.first_column; c < body.last_column; ++c)
        w.column[at(c)] = {Vector3d::Zero(), Vector3d::Zero()};
      for (int k = body.first_primitive; k < body.last_primitive; ++k) {
        const auto& primitive = model.primitives()[at(k)];
        const double value = evaluate_primitive(primitive, k, w);
        Spatial& s = w.primitive[at(k)];
        if (primitive.is_rotation) {
          s.w.noalias() = R * primitive.axis;
          s.v = p.cross(s.w);
          rotate_by(R, primitive, value);
        } else {
          s.w.setZero();
          s.v.noalias() = w.joint_rotation[b] * primitive.axis;
          p += value * s.v;
        }
        if (primitive.column >= 0) {
          w.column[at(primitive.column)].w += w.slope[at(k)] * s.w;
          w.column[at(primitive.column)].v += w.slope[at(k)] * s.v;
        }
        if (primitive.second_column >= 0) {
          w.column[at(primitive.second_column)].w += w.second_slope[at(k)] * s.w;
          w.column[at(primitive.second_column)].v += w.second_slope[at(k)] * s.v;
        }
      }
    }
    w.joint_out_rotation[b] = R;
    if (body.plain_child_rotation)
      w.rotation[b] = R;
    else
      w.rotation[b].noalias() = R * body.body_from_joint.rotation.transpose();
    w.position[b] = p - w.rotation[b] * body.body_from_joint.translation;
  }
  for (int m = 0; m < model.marker_count(); ++m) {
    const auto& marker = model.markers()[at(m)];
    w.marker.col(m) = point_in_world(w, marker.body, marker.x_in_body);
  }
}

void velocities(const Model& model, Workspace& w, const VectorXd& v) {
  w.v = v;
  const auto bodies = model.bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Model::Body& body = bodies[b];
    Spatial u, a;
    if (body.parent >= 0) {
      u = w.body_velocity[at(body.parent)];
      a = w.body_bias[at(body.parent)];
    }
    if (body.free_joint >= 0) {
      // The three translations are fixed in the ground; the three rotation axes rotate with the body. The
      // joint's own angular velocity does not contribute (its cross product with itself is 0).
      const int speed = model.free_joints()[at(body.free_joint)].speed_idx;
      Spatial rotation;
      for (int i = 0; i < 3; ++i) {
        u.v += v[speed + i] * w.column[at(body.first_column + i)].v;
        rotation.w += v[speed + 3 + i] * w.column[at(body.first_column + 3 + i)].w;
        rotation.v += v[speed + 3 + i] * w.column[at(body.first_column + 3 + i)].v;
      }
      a.w += u.w.cross(rotation.w);
      a.v += u.w.cross(rotation.v) + u.v.cross(rotation.w);
      u.w += rotation.w;
      u.v += rotation.v;
    }
    for (int k = body.first_primitive; k < body.last_primitive; ++k) {
      const auto& primitive = model.primitives()[at(k)];
      const double vc = primitive.column >= 0 ? v[model.columns()[at(primitive.column)].speed] : 0.0;
      const double vd =
          primitive.second_column >= 0 ? v[model.columns()[at(primitive.second_column)].speed] : 0.0;
      const double rate = w.slope[at(k)] * vc + w.second_slope[at(k)] * vd;
      const double rate_bias = w.curvature[at(k)] * vc * vc + 2.0 * w.cross_curvature[at(k)] * vc * vd +
                               w.second_curvature[at(k)] * vd * vd;
      const Spatial& s = w.primitive[at(k)];
      a.w += rate * u.w.cross(s.w) + rate_bias * s.w;
      a.v += rate * (u.w.cross(s.v) + u.v.cross(s.w)) + rate_bias * s.v;
      u.w += rate * s.w;
      u.v += rate * s.v;
    }
    w.body_velocity[b] = u;
    w.body_bias[b] = a;
  }
}

Vector3d point_in_world(const Workspace& w, int body, const Vector3d& x_in_body) {
  if (body < 0) return x_in_body;
  return w.position[at(body)] + w.rotation[at(body)] * x_in_body;
}

Vector3d point_velocity(const Workspace& w, int body, const Vector3d& x_in_world) {
  if (body < 0) return Vector3d::Zero();
  const Spatial& u = w.body_velocity[at(body)];
  return u.v + u.w.cross(x_in_world);
}

Vector3d point_bias_acceleration(const Workspace& w, int body, const Vector3d& x_in_world) {
  if (body < 0) return Vector3d::Zero();
  const Spatial &u = w.body_velocity[at(body)], &a = w.body_bias[at(body)];
  return a.v + a.w.cross(x_in_world) + u.w.cross(u.v + u.w.cross(x_in_world));
}

void point_jacobian(const Model& model, const Workspace& w, int body, const Vector3d& x_in_world,
                    Eigen::Ref<Eigen::MatrixXd> J) {
  J.setZero();
  if (body < 0) return;
  for (const int c : model.bodies()[at(body)].support) {
    const Spatial& s = w.column[at(c)];
    J.col(model.columns()[at(c)].speed) += s.v + s.w.cross(x_in_world);
  }
}

void marker_jacobian(const Model& model, const Workspace& w, Eigen::MatrixXd& J) {
  J.resize(3 * model.marker_count(), model.speed_count());
  for (int m = 0; m < model.marker_count(); ++m)
    point_jacobian(model, w, model.markers()[at(m)].body, w.marker.col(m), J.middleRows(3 * m, 3));
}

void marker_bias_acceleration(const Model& model, const Workspace& w, VectorXd& out) {
  out.resize(3 * model.marker_count());
  for (int m = 0; m < model.marker_count(); ++m)
    out.segment<3>(3 * m) = point_bias_acceleration(w, model.markers()[at(m)].body, w.marker.col(m));
}

void point_constraint_gaps(const Model& model, const Workspace& w, VectorXd& gap) {
  const auto constraints = model.point_constraints();
  gap.resize(3 * static_cast<Eigen::Index>(constraints.size()));
  for (std::size_t k = 0; k < constraints.size(); ++k)
    gap.segment<3>(3 * static_cast<Eigen::Index>(k)) =
        point_in_world(w, constraints[k].body_a, constraints[k].point_in_a) -
        point_in_world(w, constraints[k].body_b, constraints[k].point_in_b);
}

void point_constraint_jacobian(const Model& model, const Workspace& w, Eigen::MatrixXd& C) {
  const auto constraints = model.point_constraints();
  C.setZero(3 * static_cast<Eigen::Index>(constraints.size()), model.speed_count());
  for (std::size_t k = 0; k < constraints.size(); ++k)
    for (const bool is_a : {true, false}) {
      const int body = is_a ? constraints[k].body_a : constraints[k].body_b;
      if (body < 0) continue;
      const Vector3d p =
          point_in_world(w, body, is_a ? constraints[k].point_in_a : constraints[k].point_in_b);
      for (const int c : model.bodies()[at(body)].support) {
        const Spatial& s = w.column[at(c)];
        const Vector3d move = s.v + s.w.cross(p);
        C.block<3, 1>(3 * static_cast<Eigen::Index>(k), model.columns()[at(c)].speed) +=
            is_a ? move : Vector3d(-move);
      }
    }
}

}  // namespace kinemark::model
