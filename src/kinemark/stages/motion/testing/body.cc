// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/testing/body.h"

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/math/euler.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion::testing_body {

using data::AxisDescription;
using Eigen::Vector3d;
using math::ScalarFunction;

namespace {

AxisDescription rotation(int coordinate, const Vector3d& axis, ScalarFunction f = {}) {
  return {.is_rotation = true, .axis = axis, .coordinate_idx = coordinate, .function = std::move(f)};
}
AxisDescription slide(int coordinate, const Vector3d& axis, ScalarFunction f = {}) {
  return {.is_rotation = false, .axis = axis, .coordinate_idx = coordinate, .function = std::move(f)};
}

}  // namespace

data::ModelDescription description() {
  const Vector3d X = Vector3d::UnitX(), Y = Vector3d::UnitY(), Z = Vector3d::UnitZ();
  data::ModelDescription m;
  m.name = "test body";
  for (const char* name : {"trunk", "upper_arm", "forearm", "thigh", "shank", "kneecap"})
    m.bodies.push_back({.name = name, .mass = 1.0, .inertia_about_com = Eigen::Matrix3d::Identity() * 0.01});
  for (const char* name : {"tilt", "list", "turn"}) m.coordinates.push_back({.name = name});
  for (const char* name : {"tx", "ty", "tz"}) m.coordinates.push_back({.name = name, .is_rotation = false});
  for (const char* name : {"arm_flex", "arm_add", "arm_rot", "elbow", "hip", "knee", "kneecap_angle"})
    m.coordinates.push_back({.name = name, .range_min = -2.5, .range_max = 2.5, .clamped = true});
  const auto rolling = ScalarFunction::simm_spline({-2.5, -1.2, -0.5, 0.0, 0.8, 2.5},
                                                   {0.01, 0.006, 0.002, 0.0, -0.004, -0.01});
  m.joints = {
      {.name = "root",
       .child_body_idx = 0,
       .axes = {rotation(0, Z), rotation(1, X), rotation(2, Y), slide(3, X), slide(4, Y), slide(5, Z)}},
      {.name = "shoulder",
       .parent_body_idx = 0,
       .child_body_idx = 1,
       .parent_from_joint = {math::from_body_xyz({0.1, -0.2, 0.3}), {0.0, 0.4, 0.2}},
       .axes = {rotation(6, Z), rotation(7, X), rotation(8, Y)}},
      {.name = "elbow",
       .parent_body_idx = 1,
       .child_body_idx = 2,
       .parent_from_joint = {Eigen::Matrix3d::Identity(), {0.0, -0.3, 0.0}},
       .child_from_joint = {math::from_body_xyz({0.0, 0.2, 0.0}), {0.01, 0.0, 0.0}},
       .axes = {rotation(9, Vector3d(0.2, 0.05, 0.97))}},
      {.name = "hip",
       .parent_body_idx = 0,
       .child_body_idx = 3,
       .parent_from_joint = {Eigen::Matrix3d::Identity(), {0.0, -0.1, 0.1}},
       .axes = {rotation(10, Z)}},
      {.name = "knee",
       .parent_body_idx = 3,
       .child_body_idx = 4,
       .parent_from_joint = {Eigen::Matrix3d::Identity(), {0.0, -0.4, 0.0}},
       .axes = {rotation(11, Z), rotation(11, X, ScalarFunction::linear(0.1, 0.0)), slide(11, X, *rolling)}},
      {.name = "kneecap",
       .parent_body_idx = 3,
       .child_body_idx = 5,
       .parent_from_joint = {Eigen::Matrix3d::Identity(), {0.04, -0.4, 0.0}},
       .axes = {rotation(12, Z)}},
  };
  m.couplings = {{.name = "kneecap follows",
                  .dependent_idx = 12,
                  .independent_idx = 11,
                  .function = ScalarFunction::linear(0.6, 0.05)}};
  const auto marker = [&](const char* name, int body, double x, double y, double z) {
    m.markers.push_back({.name = name, .body_idx = body, .x_in_body = {x, y, z}});
  };
  marker("T1", 0, 0.1, 0.0, 0.12);
  marker("T2", 0, 0.1, 0.0, -0.12);
  marker("T3", 0, -0.1, 0.35, 0.0);
  marker("T4", 0, 0.08, 0.4, 0.02);
  marker("U1", 1, 0.05, -0.1, 0.02);
  marker("U2", 1, -0.03, -0.25, 0.05);
  marker("F1", 2, 0.04, -0.1, 0.03);
  marker("F2", 2, -0.02, -0.25, 0.04);
  marker("H1", 3, 0.08, -0.15, 0.03);
  marker("H2", 3, -0.04, -0.3, 0.06);
  marker("S1", 4, 0.05, -0.1, 0.03);
  marker("S2", 4, 0.0, -0.3, 0.05);
  marker("S3", 4, 0.1, -0.38, 0.0);
  marker("K1", 5, 0.03, 0.01, 0.0);
  return m;
}

Eigen::VectorXd coordinates(const model::Model& model, std::int64_t frame, double rate_hz) {
  const double t = static_cast<double>(frame) / rate_hz;
  Eigen::VectorXd q(model.coordinate_count());
  for (int c = 0; c < q.size(); ++c)
    q[c] = 0.15 * c - 0.6 + 0.5 * std::sin(2.0 * (0.4 + 0.07 * c) * t + 0.9 * c);
  if (model.coordinate_count() > 12) q[12] = 0.6 * q[11] + 0.05;
  return q;
}

data::Trajectories record(const model::Model& model, std::int64_t frames, double noise_sd_m,
                          std::uint64_t seed) {
  std::vector<std::string> names;
  for (const auto& marker : model.description().markers) names.push_back(marker.name);
  auto markers = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .t0_s = 0.0, .frames = frames});
  model::Workspace w(model);
  Random random(seed, 77);
  for (std::int64_t f = 0; f < frames; ++f) {
    model::kinematics(model, w, model::state_from_coordinates(model, coordinates(model, f)));
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      const Vector3d noise{random.gaussian(), random.gaussian(), random.gaussian()};  // braces fix the order
      markers.x(f, m) = w.marker.col(m) + noise_sd_m * noise;
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  }
  return markers;
}

double angle_rms(const model::Model& model, const data::JointMotion& motion, std::int64_t skip) {
  double squares = 0.0;
  std::int64_t count = 0;
  for (std::int64_t f = skip; f < motion.frames(); ++f) {
    const Eigen::VectorXd q = coordinates(model, f);
    for (std::int64_t c = 6; c < motion.size(); ++c, ++count)
      squares += std::pow(motion.q[motion.index(f, c)] - q[c], 2);
  }
  return std::sqrt(squares / static_cast<double>(count));
}

}  // namespace kinemark::motion::testing_body
