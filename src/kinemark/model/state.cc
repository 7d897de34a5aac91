// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/model/state.h"

#include <Eigen/Geometry>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/math/euler.h"

namespace kinemark::model {
namespace {

Eigen::Quaterniond quaternion_of(const VectorXd& x, int state_idx) {
  return {x[state_idx + 3], x[state_idx + 4], x[state_idx + 5], x[state_idx + 6]};
}

void store(const Eigen::Quaterniond& rotation, VectorXd& x, int state_idx) {
  x[state_idx + 3] = rotation.w();
  x[state_idx + 4] = rotation.x();
  x[state_idx + 5] = rotation.y();
  x[state_idx + 6] = rotation.z();
}

// exp of half a rotation vector as a quaternion; the series near zero keeps full precision.
Eigen::Quaterniond exp_quaternion(const Vector3d& w) {
  const double angle = w.norm();
  const double half_sinc = angle < 1e-8 ? 0.5 : std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), half_sinc * w.x(), half_sinc * w.y(), half_sinc * w.z()};
}

}  // namespace

void integrate(const Model& model, VectorXd& x, const VectorXd& dv) {
  check(x.size() == model.state_count() && dv.size() == model.speed_count(),
        "state or motion has the wrong size");
  for (const auto& c : model.coordinates())
    if (c.state_idx >= 0) x[c.state_idx] += dv[c.speed_idx];
  for (const auto& free : model.free_joints()) {
    x.segment<3>(free.state_idx) += dv.segment<3>(free.speed_idx);
    store((quaternion_of(x, free.state_idx) * exp_quaternion(dv.segment<3>(free.speed_idx + 3))).normalized(),
          x, free.state_idx);
  }
}

void difference(const Model& model, const VectorXd& from, const VectorXd& to, VectorXd& dv) {
  dv.setZero(model.speed_count());
  for (const auto& c : model.coordinates())
    if (c.state_idx >= 0) dv[c.speed_idx] = to[c.state_idx] - from[c.state_idx];
  for (const auto& free : model.free_joints()) {
    dv.segment<3>(free.speed_idx) = to.segment<3>(free.state_idx) - from.segment<3>(free.state_idx);
    Eigen::Quaterniond rotation =
        quaternion_of(from, free.state_idx).conjugate() * quaternion_of(to, free.state_idx);
    if (rotation.w() < 0.0) rotation.coeffs() = -rotation.coeffs();
    const double s = rotation.vec().norm();
    const double scale = s < 1e-12 ? 2.0 : 2.0 * std::atan2(s, rotation.w()) / s;
    dv.segment<3>(free.speed_idx + 3) = scale * rotation.vec();
  }
}

VectorXd state_from_coordinates(const Model& model, const VectorXd& q) {
  check(q.size() == model.coordinate_count(), "q must have one number per coordinate");
  VectorXd x(model.state_count());
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const auto& coordinate = model.coordinates()[at(c)];
    if (coordinate.state_idx >= 0) x[coordinate.state_idx] = q[c];
  }
  for (const auto& free : model.free_joints()) {
    Matrix3d R = Matrix3d::Identity();
    Vector3d p = Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
      R = R * math::axis_angle(free.rotation_axes.col(i), q[free.rotation_coordinate[i]]);
      p += q[free.translation_coordinate[i]] * free.translation_axes.col(i);
    }
    x.segment<3>(free.state_idx) = p;
    store(Eigen::Quaterniond(R).normalized(), x, free.state_idx);
  }
  return x;
}

void coordinates_from_state(const Model& model, const VectorXd& x, const VectorXd& near, VectorXd& q) {
  check(x.size() == model.state_count() && near.size() == model.coordinate_count(),
        "state or q has the wrong size");
  if (q.size() != model.coordinate_count()) q.resize(model.coordinate_count());
  for (const int c : model.coordinate_order()) {
    const auto& coordinate = model.coordinates()[at(c)];
    if (coordinate.state_idx >= 0)
      q[c] = x[coordinate.state_idx];
    else if (coordinate.source >= 0)
      q[c] = coordinate.coupling(q[coordinate.source]).f;
    else if (coordinate.free_joint < 0)
      q[c] = model.description().coordinates[at(c)].default_value;
  }
  for (const auto& free : model.free_joints()) {
    const Vector3d near_angles(near[free.rotation_coordinate[0]], near[free.rotation_coordinate[1]],
                               near[free.rotation_coordinate[2]]);
    const Vector3d angles = math::to_angles_about(
        free.rotation_axes, quaternion_of(x, free.state_idx).toRotationMatrix(), near_angles);
    const Vector3d slides = free.translation_axes.transpose() * x.segment<3>(free.state_idx);
    for (int i = 0; i < 3; ++i) {
      q[free.rotation_coordinate[i]] = angles[i];
      q[free.translation_coordinate[i]] = slides[i];
    }
  }
}

void coordinate_jacobian(const Model& model, const Workspace& w, const VectorXd& q, Eigen::MatrixXd& E) {
  E.setZero(model.coordinate_count(), model.speed_count());
  for (int c = 0; c < model.coordinate_count(); ++c) {
    int source = c;
    while (model.coordinates()[at(source)].source >= 0) source = model.coordinates()[at(source)].source;
    const int speed = model.coordinates()[at(source)].speed_idx;
    if (speed >= 0) E(c, speed) = w.q_slope[c];
  }
  for (const auto& free : model.free_joints()) {
    // Angular velocity in the child's axes: B theta', B = [R2'R1'a0, R2'a1, a2]; the rates are B^-1 of it.
    const Matrix3d R1 = math::axis_angle(free.rotation_axes.col(1), q[free.rotation_coordinate[1]]);
    const Matrix3d R2 = math::axis_angle(free.rotation_axes.col(2), q[free.rotation_coordinate[2]]);
    Matrix3d B;
    B.col(0) = R2.transpose() * (R1.transpose() * free.rotation_axes.col(0));
    B.col(1) = R2.transpose() * free.rotation_axes.col(1);
    B.col(2) = free.rotation_axes.col(2);
    const Matrix3d rates = B.inverse();
    for (int i = 0; i < 3; ++i) {
      E.block<1, 3>(free.rotation_coordinate[i], free.speed_idx + 3) = rates.row(i);
      E.block<1, 3>(free.translation_coordinate[i], free.speed_idx) =
          free.translation_axes.col(i).transpose();
    }
  }
}

}  // namespace kinemark::model
