// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/turning_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"

namespace kinemark::motion::internal {
namespace {

constexpr int kTips = 3;

std::string tip_name(std::size_t sensor, int axis) {
  return fmt::format("sensor {} {}", sensor, "xyz"[axis]);
}

}  // namespace

data::ModelDescription turning_model(const data::ModelDescription& model,
                                     const std::vector<SensorTips>& sensors) {
  data::ModelDescription out = model;
  out.point_constraints.clear();
  for (auto& joint : out.joints) {
    joint.parent_from_joint.translation.setZero();
    joint.child_from_joint.translation.setZero();
    std::erase_if(joint.axes, [](const auto& axis) { return !axis.is_rotation; });
  }
  out.markers.clear();
  for (std::size_t s = 0; s < sensors.size(); ++s)
    for (int k = 0; k < kTips; ++k)
      out.markers.push_back({.name = tip_name(s, k),
                             .body_idx = sensors[s].body_idx,
                             .x_in_body = kAxis_m * sensors[s].body_from_sensor.col(k)});
  return out;
}

std::vector<bool> turning_coordinates(const data::ModelDescription& model) {
  std::vector<bool> turns(model.coordinates.size(), false);
  for (const auto& joint : model.joints)
    for (const auto& axis : joint.axes)
      for (const int c : {axis.coordinate_idx, axis.second_coordinate_idx})
        if (axis.is_rotation && c >= 0) turns[at(c)] = true;
  // A chain of couplings is at most as long as there are couplings.
  for (std::size_t round = 0; round < model.couplings.size(); ++round)
    for (const auto& coupling : model.couplings) {
      const bool either = turns[at(coupling.dependent_idx)] || turns[at(coupling.independent_idx)];
      turns[at(coupling.independent_idx)] = either;
      turns[at(coupling.dependent_idx)] = either;
    }
  return turns;
}

data::Trajectories record_tips(const data::Orientations& recording, const std::vector<SensorTips>& sensors,
                               const Eigen::Matrix3d& model_from_world,
                               const std::vector<std::int64_t>& frames) {
  data::Trajectories out;
  out.time = recording.time;
  out.time.frames = static_cast<std::int64_t>(frames.size());
  if (!frames.empty()) {
    out.time.t0_s = recording.time.time_s(frames.front());
    out.time.first_number = recording.time.number(frames.front());
  }
  for (std::size_t s = 0; s < sensors.size(); ++s)
    for (int k = 0; k < kTips; ++k) out.names.push_back(tip_name(s, k));
  const auto samples = frames.size() * out.names.size();
  out.x_in_world.assign(3 * samples, kNaN);
  out.state.assign(samples, data::SampleState::missing);
  std::size_t sample = 0;
  for (const auto f : frames)
    for (const auto& sensor : sensors) {
      const bool there = recording.present(f, sensor.column);
      const Eigen::Matrix3d tips =
          there ? Eigen::Matrix3d(kAxis_m * model_from_world * recording.rotation(f, sensor.column))
                : Eigen::Matrix3d::Constant(kNaN);
      for (int k = 0; k < kTips; ++k, ++sample) {
        std::copy_n(tips.data() + at(3 * k), 3, out.x_in_world.data() + 3 * sample);
        if (there) out.state[sample] = data::SampleState::measured;
      }
    }
  return out;
}

double angle_of_tips(double squares_m2) {
  // |R - S|^2 = 4 (1 - cos angle) = 8 sin^2(angle / 2)
  return 2.0 * std::asin(std::min(1.0, std::sqrt(squares_m2 / 8.0) / kAxis_m));
}

}  // namespace kinemark::motion::internal
