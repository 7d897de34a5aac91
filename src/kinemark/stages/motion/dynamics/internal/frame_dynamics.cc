// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/dynamics/internal/frame_dynamics.h"

#include <Eigen/LU>
#include <limits>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/model/coordinate_rates.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/weighted_normal.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kStep = 1e-6;       // rad or m
constexpr double kSpeedStep = 1e-3;  // rad/s or m/s: forces are quadratic in the speeds, so that the central
                                     // difference is exact

/// Angular velocity in the child's axes per Euler rate.
Matrix3d angular_from_rates(const model::Model::FreeJoint& free, const Eigen::MatrixXd& E) {
  Matrix3d rates;
  for (int i = 0; i < 3; ++i) rates.row(i) = E.block<1, 3>(free.rotation_coordinate[i], free.speed_idx + 3);
  return rates.inverse();
}

}  // namespace

FrameDynamics::FrameDynamics(const model::Model& model) : model_(model), w_(model) {
  for (auto* v : {&v_, &vdot_, &tau_, &direction_, &outside_, &moved_v_}) v->setZero(model.speed_count());
  E_.setZero(model.coordinate_count(), model.speed_count());
}

void FrameDynamics::set(const VectorXd& q, const VectorXd& qd, const VectorXd& qdd,
                        std::vector<AppliedForce> applied) {
  applied_ = std::move(applied);
  x_ = model::state_from_coordinates(model_, q);
  model::speeds_from_rates(model_, q, qd, qdd, v_, vdot_);
  evaluate(x_, v_, vdot_, tau_);
  model::coordinate_jacobian(model_, w_, q, E_);
}

void FrameDynamics::evaluate(const VectorXd& x, const VectorXd& v, const VectorXd& vdot, VectorXd& tau) {
  model::kinematics(model_, w_, x);
  model::velocities(model_, w_, v);
  model::inverse_dynamics(model_, w_, vdot, tau);
  if (applied_.empty()) return;
  model::clear_forces(w_);
  for (const auto& f : applied_) {
    if (f.body < 0) continue;
    model::add_force(w_, f.body, f.point, f.force);
    w_.force[at(f.body)].w += f.moment;
  }
  model::project_forces(model_, w_, outside_);
  tau -= outside_;
}

void FrameDynamics::to_coordinates(const VectorXd& tau, VectorXd& out) const {
  out.setConstant(model_.coordinate_count(), std::numeric_limits<double>::quiet_NaN());
  for (int c = 0; c < model_.coordinate_count(); ++c) {
    const int speed = model_.coordinates()[at(c)].speed_idx;
    if (speed >= 0) out[c] = tau[speed];
  }
  for (const auto& free : model_.free_joints()) {
    const Vector3d torques = angular_from_rates(free, E_).transpose() * tau.segment<3>(free.speed_idx + 3);
    const Vector3d slides = free.translation_axes.transpose() * tau.segment<3>(free.speed_idx);
    for (int i = 0; i < 3; ++i) {
      out[free.rotation_coordinate[i]] = torques[i];
      out[free.translation_coordinate[i]] = slides[i];
    }
  }
}

bool FrameDynamics::derivatives(int c, VectorXd& by_q, VectorXd& by_v, VectorXd& by_a) {
  const auto& coordinate = model_.coordinates()[at(c)];
  direction_.setZero();
  if (coordinate.speed_idx >= 0) {
    direction_[coordinate.speed_idx] = 1.0;
  } else if (coordinate.free_joint >= 0) {
    // Axis of this Euler angle at present; the rotation of the axes with the other angles is a second-order
    // effect of the error of the angle.
    const auto& free = model_.free_joints()[at(coordinate.free_joint)];
    if (coordinate.free_axis < 3)
      direction_.segment<3>(free.speed_idx + 3) = angular_from_rates(free, E_).col(coordinate.free_axis);
    else
      direction_.segment<3>(free.speed_idx) = free.translation_axes.col(coordinate.free_axis - 3);
  } else {
    return false;
  }
  moved_ = x_;
  moved_v_ = kStep * direction_;
  model::integrate(model_, moved_, moved_v_);
  evaluate(moved_, v_, vdot_, by_q);
  by_q = (by_q - tau_) / kStep;

  moved_v_ = v_ + kSpeedStep * direction_;
  evaluate(x_, moved_v_, vdot_, by_v);
  moved_v_ = v_ - kSpeedStep * direction_;
  model::velocities(model_, w_, moved_v_);
  model::inverse_dynamics(model_, w_, vdot_, by_a);
  if (!applied_.empty()) by_a -= outside_;
  by_v = (by_v - by_a) / (2.0 * kSpeedStep);

  model::velocities(model_, w_, v_);
  model::inverse_dynamics(model_, w_, vdot_ + direction_, by_a);
  if (!applied_.empty()) by_a -= outside_;
  by_a -= tau_;
  return true;
}

RootFrame FrameDynamics::root_frame(const model::Model::FreeJoint& root, const std::vector<int>& feet) const {
  RootFrame out{.force = w_.joint_rotation[at(root.body)] * tau_.segment<3>(root.speed_idx),
                .moment = w_.joint_out_rotation[at(root.body)] * tau_.segment<3>(root.speed_idx + 3),
                .origin = model::point_in_world(w_, root.body,
                                                model_.bodies()[at(root.body)].body_from_joint.translation),
                .centre = Vector3d::Zero(),
                .feet = {},
                .on_plate = {}};
  double mass_kg = 0.0;
  for (std::size_t b = 0; b < model_.bodies().size(); ++b) {
    const auto& body = model_.bodies()[b];
    out.centre += body.mass * model::point_in_world(w_, static_cast<int>(b), body.com_in_body);
    mass_kg += body.mass;
  }
  out.centre /= mass_kg;
  for (const int foot : feet)
    out.feet.push_back(model::point_in_world(w_, foot, model_.bodies()[at(foot)].com_in_body));
  return out;
}

}  // namespace kinemark::motion::internal
