// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/testing/sensors.h"

#include <Eigen/Geometry>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion::testing_body {

model::Model one_way_body() {
  auto description = testing_body::description();
  for (const char* name : {"elbow", "knee"})
    description.coordinates[static_cast<std::size_t>(description.find_coordinate(name))].range_min = -0.1;
  return model::Model::compile(description).value();
}

Session session(double heading_rad, double noise_rad, std::uint64_t seed, std::int64_t frames,
                const std::vector<std::string>& bodies, double rate_hz) {
  Session out;
  Random random(seed, 5);
  const auto noise = [&]() -> Eigen::Matrix3d {
    const Eigen::Vector3d v(random.gaussian(), random.gaussian(), random.gaussian());
    return Eigen::AngleAxisd(noise_rad * v.norm(), v.normalized()).toRotationMatrix();
  };
  const Eigen::Matrix3d world_from_model =
      Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()) *
      Eigen::AngleAxisd(-heading_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  std::vector<Eigen::Matrix3d> body_from_sensor;
  std::vector<std::size_t> index;
  model::Workspace w(out.model);
  for (auto* one : {&out.pose, &out.recording})
    one->time = {.rate_hz = rate_hz, .t0_s = 0.0, .frames = one == &out.pose ? 20 : frames};
  for (const auto& body : bodies) {
    const Eigen::Vector3d turn(random.gaussian(), random.gaussian(), random.gaussian());
    body_from_sensor.emplace_back(Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix());
    for (std::size_t b = 0; b < out.model.bodies().size(); ++b)
      if (out.model.description()
              .bodies[static_cast<std::size_t>(out.model.bodies()[b].description_idx)]
              .name == body)
        index.push_back(b);
    for (auto* one : {&out.pose, &out.recording}) one->names.push_back(body + "_imu");
  }
  out.truth.resize(out.model.coordinate_count(), frames);
  for (auto* one : {&out.pose, &out.recording})
    for (std::int64_t f = 0; f < one->frames(); ++f) {
      Eigen::VectorXd x = out.model.default_state();
      if (one == &out.recording) {
        out.truth.col(f) = testing_body::coordinates(out.model, f, rate_hz);
        x = model::state_from_coordinates(out.model, out.truth.col(f));
      }
      model::kinematics(out.model, w, x);
      for (std::size_t s = 0; s < bodies.size(); ++s) {
        const Eigen::Matrix3d rotation =
            noise() * world_from_model * w.rotation[index[s]] * body_from_sensor[s];
        const Eigen::Quaterniond q(rotation);
        one->quaternion.insert(one->quaternion.end(), {q.w(), q.x(), q.y(), q.z()});
      }
    }
  return out;
}

}  // namespace kinemark::motion::testing_body
