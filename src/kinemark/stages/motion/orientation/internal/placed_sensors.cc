// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/placed_sensors.h"

#include <Eigen/Geometry>

#include "kinemark/core/index.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kSmallTurn = 1e-4;  // rad, of the heading

/// A sensor that takes part, under the heading and under one a small turn off.
struct Standing {
  std::int64_t column = 0;
  Eigen::Matrix3d here, beside;  // body_from_sensor
};

void turn(const data::Orientations& sensors, const PosedSensors& posed, double heading_rad,
          const std::vector<Standing>& standing, TurnedBodies& out) {
  const Eigen::Matrix3d here = Eigen::AngleAxisd(heading_rad, posed.up) * posed.model_from_world;
  const Eigen::Matrix3d beside =
      Eigen::AngleAxisd(heading_rad + kSmallTurn, posed.up) * posed.model_from_world;
  for (std::int64_t f = 0; f < sensors.frames(); ++f)
    for (const auto& sensor : standing) {
      if (!sensors.present(f, sensor.column)) {
        out.turned.emplace_back(Eigen::Matrix3d::Constant(kNaN));
        out.by_heading.emplace_back(Eigen::Vector3d::Zero());
        continue;
      }
      const Eigen::Matrix3d R = sensors.rotation(f, sensor.column);
      out.turned.emplace_back(here * R * sensor.here.transpose());
      const Eigen::AngleAxisd by(
          Eigen::Matrix3d(beside * R * sensor.beside.transpose() * out.turned.back().transpose()));
      out.by_heading.emplace_back(by.angle() / kSmallTurn * by.axis());
    }
}

}  // namespace

TurnedBodies turn_bodies(const model::Model& model, const data::Orientations& sensors,
                         const PosedSensors& posed, const MarkerMounts& mounts, const Heading& heading,
                         OrientationFit& fit) {
  TurnedBodies out;
  out.heading_variance = heading.sd_rad * heading.sd_rad;
  std::vector<Standing> standing;
  for (std::size_t s = 0; s < posed.sensors.size(); ++s) {
    const auto& sensor = posed.sensors[s];
    const auto& name = sensors.names[at(sensor.column)];
    const bool by_markers = mounts.by_markers(s);
    if (posed.unplaced && !by_markers) {
      fit.unplaced.push_back(name);
      continue;
    }
    const auto stands = [&](double rad) {
      return by_markers ? mounts.body_from_sensor(s, rad) : body_from_sensor(posed, sensor, rad);
    };
    standing.push_back(
        {.column = sensor.column, .here = stands(heading.rad), .beside = stands(heading.rad + kSmallTurn)});
    const auto placed_by = posed.by_model ? SensorPlacement::model
                           : by_markers   ? SensorPlacement::markers
                                          : SensorPlacement::pose;
    out.body.push_back(model.body_of(sensor.body_idx));
    out.placing_variance.push_back(by_markers ? mounts.variance(s) : 0.0);
    out.placing_share.push_back(
        placed_by == SensorPlacement::pose ? 1.0 / static_cast<double>(posed.pose_frames) : 0.0);
    fit.sensors.push_back({.name = name,
                           .body = model.description().bodies[at(sensor.body_idx)].name,
                           .body_from_sensor = standing.back().here,
                           .placed_by = placed_by});
  }
  turn(sensors, posed, heading.rad, standing, out);
  return out;
}

}  // namespace kinemark::motion::internal
