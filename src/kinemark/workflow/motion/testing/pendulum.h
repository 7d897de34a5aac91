// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"

namespace kinemark::workflow::testing {

/// A point mass on a massless rod that swings about z, y is up; its angle is a sine in time.
struct Pendulum {
  double mass_kg = 2.0, length_m = 0.3, gravity = 9.81;
  double amplitude = 0.5, frequency = 2.0 * std::numbers::pi * 0.8;  // rad, rad/s
  model::Model model = compiled();

  [[nodiscard]] double q(double t) const { return amplitude * std::sin(frequency * t); }
  [[nodiscard]] double qd(double t) const { return amplitude * frequency * std::cos(frequency * t); }
  [[nodiscard]] double qdd(double t) const { return -frequency * frequency * q(t); }
  /// What moves it so: m l^2 q'' + m g l sin q.
  [[nodiscard]] double torque(double t) const {
    return mass_kg * length_m * (length_m * qdd(t) + gravity * std::sin(q(t)));
  }

  /// Six seconds at 100 Hz; with a deviation each angle has noise of that size, and says so.
  [[nodiscard]] data::JointMotion motion(double q_sd = 0.0) const {
    data::JointMotion out;
    out.coordinates = {"swing"};
    out.is_rotation = {true};
    out.time = {.rate_hz = 100.0, .frames = 600};
    Random random(7, 0);
    for (std::int64_t f = 0; f < out.frames(); ++f) {
      out.q.push_back(q(out.time.time_s(f)) + q_sd * random.gaussian());
      if (q_sd > 0.0) out.q_sd.push_back(q_sd);
    }
    return out;
  }

 private:
  [[nodiscard]] model::Model compiled() const {
    data::ModelDescription m;
    m.name = "pendulum";
    m.gravity = {0.0, -gravity, 0.0};
    m.bodies = {{.name = "rod", .mass = mass_kg, .com_in_body = {0.0, -length_m, 0.0}}};
    m.coordinates = {{.name = "swing"}};
    m.joints = {{.name = "hinge",
                 .child_body_idx = 0,
                 .axes = {{.axis = Eigen::Vector3d::UnitZ(), .coordinate_idx = 0}}}};
    return model::Model::compile(m).value();
  }
};

}  // namespace kinemark::workflow::testing
