// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/testing/planar_arm.h"

#include <utility>

namespace kinemark::motion::testing_body {

using Eigen::Vector3d;

data::ModelDescription planar_arm(const Vector3d& elbow, std::vector<data::MarkerDescription> markers) {
  data::ModelDescription m;
  m.name = "planar arm";
  for (const char* name : {"upper", "fore"})
    m.bodies.push_back({.name = name, .mass = 1.0, .inertia_about_com = Eigen::Matrix3d::Identity() * 0.01});
  for (const char* name : {"shoulder", "elbow"})
    m.coordinates.push_back({.name = name, .range_min = -2.8, .range_max = 2.8, .clamped = true});
  const auto hinge = [](int c) {
    return data::AxisDescription{.is_rotation = true, .axis = Vector3d::UnitZ(), .coordinate_idx = c};
  };
  m.joints = {{.name = "shoulder", .child_body_idx = 0, .axes = {hinge(0)}},
              {.name = "elbow",
               .parent_body_idx = 0,
               .child_body_idx = 1,
               .parent_from_joint = {Eigen::Matrix3d::Identity(), elbow},
               .axes = {hinge(1)}}};
  m.markers = std::move(markers);
  return m;
}

}  // namespace kinemark::motion::testing_body
