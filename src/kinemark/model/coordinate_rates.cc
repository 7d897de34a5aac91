// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/model/coordinate_rates.h"

#include <Eigen/LU>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/math/euler.h"

namespace kinemark::model {
namespace {

/// Angular velocity of a free joint in the child's axes is B times the Euler rates, B = [R2'R1'a0, R2'a1,
/// a2].
struct EulerRates {
  Matrix3d B;
  Vector3d carried_axis;      ///< R1'a0
  Matrix3d inverse_rotation;  ///< R2'
};

EulerRates euler_rates(const Model::FreeJoint& free, const VectorXd& q) {
  const Matrix3d R1 = math::axis_angle(free.rotation_axes.col(1), q[free.rotation_coordinate[1]]);
  EulerRates e;
  e.inverse_rotation =
      math::axis_angle(free.rotation_axes.col(2), q[free.rotation_coordinate[2]]).transpose();
  e.carried_axis = R1.transpose() * free.rotation_axes.col(0);
  e.B.col(0) = e.inverse_rotation * e.carried_axis;
  e.B.col(1) = e.inverse_rotation * free.rotation_axes.col(1);
  e.B.col(2) = free.rotation_axes.col(2);
  return e;
}

/// dB/dt times the rates: each axis is rotated back by the angles that follow its own.
Vector3d moving_axes_term(const Model::FreeJoint& free, const EulerRates& e, const Vector3d& rates) {
  const Vector3d a1 = free.rotation_axes.col(1), a2 = free.rotation_axes.col(2);
  const Vector3d first =
      -rates[2] * a2.cross(Vector3d(e.B.col(0))) - rates[1] * (e.inverse_rotation * a1.cross(e.carried_axis));
  const Vector3d second = -rates[2] * a2.cross(Vector3d(e.B.col(1)));
  return rates[0] * first + rates[1] * second;
}

}  // namespace

void speeds_from_rates(const Model& model, const VectorXd& q, const VectorXd& qd, const VectorXd& qdd,
                       VectorXd& v, VectorXd& vdot) {
  check(q.size() == model.coordinate_count() && qd.size() == q.size() && qdd.size() == q.size(),
        "q, qd or qdd has the wrong size");
  v.setZero(model.speed_count());
  vdot.setZero(model.speed_count());
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const int speed = model.coordinates()[at(c)].speed_idx;
    if (speed < 0) continue;
    v[speed] = qd[c];
    vdot[speed] = qdd[c];
  }
  for (const auto& free : model.free_joints()) {
    const EulerRates e = euler_rates(free, q);
    Vector3d rates, accelerations;
    for (int i = 0; i < 3; ++i) {
      rates[i] = qd[free.rotation_coordinate[i]];
      accelerations[i] = qdd[free.rotation_coordinate[i]];
      v.segment<3>(free.speed_idx) += qd[free.translation_coordinate[i]] * free.translation_axes.col(i);
      vdot.segment<3>(free.speed_idx) += qdd[free.translation_coordinate[i]] * free.translation_axes.col(i);
    }
    v.segment<3>(free.speed_idx + 3) = e.B * rates;
    vdot.segment<3>(free.speed_idx + 3) = e.B * accelerations + moving_axes_term(free, e, rates);
  }
}

void rates_from_speeds(const Model& model, const Workspace& w, const VectorXd& q, const VectorXd& v,
                       const VectorXd& vdot, VectorXd& qd, VectorXd& qdd) {
  check(q.size() == model.coordinate_count() && v.size() == model.speed_count() && vdot.size() == v.size(),
        "q, v or vdot has the wrong size");
  qd.setZero(model.coordinate_count());
  qdd.setZero(model.coordinate_count());
  for (int c = 0; c < model.coordinate_count(); ++c) {
    int source = c;
    while (model.coordinates()[at(source)].source >= 0) source = model.coordinates()[at(source)].source;
    const int speed = model.coordinates()[at(source)].speed_idx;
    if (speed < 0) continue;
    qd[c] = w.q_slope[c] * v[speed];
    qdd[c] = w.q_slope[c] * vdot[speed] + w.q_curvature[c] * v[speed] * v[speed];
  }
  for (const auto& free : model.free_joints()) {
    const EulerRates e = euler_rates(free, q);
    const Matrix3d inverse = e.B.inverse();
    const Vector3d rates = inverse * v.segment<3>(free.speed_idx + 3);
    const Vector3d accelerations =
        inverse * (vdot.segment<3>(free.speed_idx + 3) - moving_axes_term(free, e, rates));
    const Vector3d slides = free.translation_axes.transpose() * v.segment<3>(free.speed_idx);
    const Vector3d slide_rates = free.translation_axes.transpose() * vdot.segment<3>(free.speed_idx);
    for (int i = 0; i < 3; ++i) {
      qd[free.rotation_coordinate[i]] = rates[i];
      qdd[free.rotation_coordinate[i]] = accelerations[i];
      qd[free.translation_coordinate[i]] = slides[i];
      qdd[free.translation_coordinate[i]] = slide_rates[i];
    }
  }
}

}  // namespace kinemark::model
