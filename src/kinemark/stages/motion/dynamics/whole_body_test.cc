// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/dynamics/whole_body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "kinemark/model/coordinate_rates.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using ::testing::HasSubstr;

/// A free trunk with two links on hinges, of odd sizes.
model::Model acrobat() {
  data::ModelDescription m;
  m.name = "acrobat";
  m.gravity = {0.0, -9.81, 0.0};
  const auto inertia = [](double a, double b, double c) {
    return Eigen::Matrix3d(Vector3d(a, b, c).asDiagonal());
  };
  m.bodies = {{.name = "trunk",
               .mass = 30.0,
               .com_in_body = {0.02, 0.2, 0.0},
               .inertia_about_com = inertia(1.5, 0.4, 1.6)},
              {.name = "thigh",
               .mass = 10.0,
               .com_in_body = {0.0, -0.2, 0.01},
               .inertia_about_com = inertia(0.2, 0.05, 0.2)},
              {.name = "arm",
               .mass = 4.0,
               .com_in_body = {0.0, -0.15, 0.0},
               .inertia_about_com = inertia(0.05, 0.01, 0.05)}};
  for (const char* name : {"rx", "ry", "rz"}) m.coordinates.push_back({.name = name});
  for (const char* name : {"tx", "ty", "tz"}) m.coordinates.push_back({.name = name, .is_rotation = false});
  m.coordinates.push_back({.name = "hip"});
  m.coordinates.push_back({.name = "shoulder"});
  data::JointDescription root{.name = "root", .child_body_idx = 0};
  for (int axis = 0; axis < 3; ++axis)
    root.axes.push_back({.is_rotation = true, .axis = Vector3d::Unit(axis), .coordinate_idx = axis});
  for (int axis = 0; axis < 3; ++axis)
    root.axes.push_back({.is_rotation = false, .axis = Vector3d::Unit(axis), .coordinate_idx = 3 + axis});
  m.joints = {root,
              {.name = "hip",
               .parent_body_idx = 0,
               .child_body_idx = 1,
               .axes = {{.axis = Vector3d(0.2, 0.1, 1.0), .coordinate_idx = 6}}},
              {.name = "shoulder",
               .parent_body_idx = 0,
               .child_body_idx = 2,
               .parent_from_joint = {.translation = {0.0, 0.5, 0.2}},
               .axes = {{.axis = Vector3d(1.0, 0.0, 0.3), .coordinate_idx = 7}}}};
  return model::Model::compile(m).value();
}

/// Free flight from a tumbling start, hinges driven by torques of their own; semi-implicit midpoint steps of
/// 0.25 ms, every fortieth kept.
data::JointMotion flight(const model::Model& model, int frames) {
  data::JointMotion motion;
  motion.time = {.rate_hz = 100.0, .frames = frames};
  for (const auto& c : model.description().coordinates) {
    motion.coordinates.push_back(c.name);
    motion.is_rotation.push_back(c.is_rotation);
  }
  VectorXd q = VectorXd::Zero(8), v(8);
  q << 0.1, -0.2, 0.3, 0.0, 1.0, 0.0, 0.4, -0.3;
  v << 0.5, 3.0, 0.2, 1.0, -0.7, 2.0, 3.0, -2.0;
  VectorXd x = model::state_from_coordinates(model, q);
  model::Workspace w(model);
  Eigen::MatrixXd mass;
  VectorXd bias, weight;
  constexpr double kStep = 2.5e-4;
  constexpr int kKept = 40;
  const auto acceleration = [&](const VectorXd& state, const VectorXd& speed, double t) -> VectorXd {
    model::kinematics(model, w, state);
    model::velocities(model, w, speed);
    model::mass_matrix(model, w, mass);
    model::bias_forces(model, w, bias);
    model::gravity_forces(model, w, weight);
    VectorXd tau = VectorXd::Zero(8);
    tau[6] = 20.0 * std::sin(9.0 * t);
    tau[7] = -6.0 * std::cos(7.0 * t);
    return mass.ldlt().solve(tau - bias - weight);
  };
  for (int step = 0; step < frames * kKept; ++step) {
    const double t = kStep * step;
    if (step % kKept == 0) {
      model::kinematics(model, w, x);
      model::velocities(model, w, v);
      VectorXd rates, second;
      const VectorXd near = q;
      model::coordinates_from_state(model, x, near, q);
      model::rates_from_speeds(model, w, q, v, VectorXd::Zero(8), rates, second);
      motion.q.insert(motion.q.end(), q.data(), q.data() + 8);
      motion.qd.insert(motion.qd.end(), rates.data(), rates.data() + 8);
    }
    VectorXd middle = x;
    model::integrate(model, middle, 0.5 * kStep * v);
    const VectorXd v_middle = v + 0.5 * kStep * acceleration(x, v, t);
    const VectorXd a = acceleration(middle, v_middle, t + 0.5 * kStep);
    model::integrate(model, x, kStep * v_middle);
    v += kStep * a;
  }
  return motion;
}

TEST(WholeBody, InFreeFlightTheMomentumStaysAndTheMassCentreFalls) {
  const auto model = acrobat();
  const auto motion = flight(model, 40);
  const auto body = whole_body(model, motion).value();
  EXPECT_DOUBLE_EQ(body.mass_kg, 44.0);
  const Vector3d first = body.momentum.row(0);
  EXPECT_GT(first.norm(), 1.0);
  double hip_moves = 0.0;
  for (int f = 0; f < 40; ++f) {
    const double t = 0.01 * f;
    EXPECT_LT((body.momentum.row(f).transpose() - first).norm(), 1e-4 * first.norm()) << f;
    const Vector3d falls = body.centre_velocity.row(0).transpose() + t * model.gravity();
    EXPECT_LT((body.centre_velocity.row(f).transpose() - falls).norm(), 1e-4) << f;
    hip_moves = std::max(hip_moves, std::abs(motion.q[motion.index(f, 6)] - motion.q[motion.index(0, 6)]));
  }
  EXPECT_GT(hip_moves, 0.3) << "the parts move against each other";
}

TEST(WholeBody, TheMomentumIsThatOfItsPartsByTheirPoints) {
  // Each body as six points of equal mass on its principal axes has the body's own inertia.
  const auto model = acrobat();
  auto motion = flight(model, 2);
  std::vector<PointOnBody> points;
  std::vector<double> masses;
  for (int b = 0; b < 3; ++b) {
    const auto& body = model.bodies()[static_cast<std::size_t>(b)];
    const Vector3d i = body.inertia_about_com.diagonal();
    for (int axis = 0; axis < 3; ++axis) {
      const double second = 0.5 * (i.sum() - 2.0 * i[axis]);  // sum of m x^2 along the axis
      const double arm = std::sqrt(second / (body.mass / 3.0));
      for (const double sign : {-1.0, 1.0}) {
        points.push_back({b, body.com_in_body + sign * arm * Vector3d::Unit(axis)});
        masses.push_back(body.mass / 6.0);
      }
    }
  }
  const auto now = whole_body(model, motion, points).value();
  // The same points a moment later and before give their velocities.
  constexpr double kMoment = 1e-5;
  const auto moved = [&](double by) {
    auto other = motion;
    for (std::size_t i = 0; i < other.q.size(); ++i) other.q[i] += by * other.qd[i];
    return whole_body(model, other, points).value();
  };
  const auto later = moved(kMoment), before = moved(-kMoment);
  Vector3d momentum = Vector3d::Zero();
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vector3d v = (later.points[p].row(0) - before.points[p].row(0)) / (2.0 * kMoment);
    const Vector3d x = now.points[p].row(0) - now.centre.row(0);
    momentum += masses[p] * x.cross(v - now.centre_velocity.row(0).transpose());
  }
  EXPECT_LT((momentum - now.momentum.row(0).transpose()).norm(), 1e-6 * momentum.norm());
}

TEST(WholeBody, RefusesWhatDoesNotFit) {
  const auto model = acrobat();
  auto motion = flight(model, 2);
  motion.qd.clear();
  EXPECT_THAT(whole_body(model, motion).error().message, HasSubstr("0 speeds, the model 8"));
  data::ModelDescription light = model.description();
  for (auto& body : light.bodies) body.mass = 0.0, body.inertia_about_com.setZero();
  EXPECT_THAT(whole_body(model::Model::compile(light).value(), flight(model, 2)).error().message,
              HasSubstr("model 'acrobat' has no mass"));
}

}  // namespace
}  // namespace kinemark::motion
