// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A body that its marker names lead to expect, in steps: thighs swing about the hips, shanks about the knees.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/foundations/standing_body.h"

namespace kinemark::motion::testing {

/// Landmarks of these names at 100 Hz, 10 mm forward a frame; x forward, y up, z to the right.
inline data::Trajectories walking_body(const std::vector<std::string>& names, std::int64_t frames) {
  const auto body = body_of_names(names);
  auto walk = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .frames = frames});
  for (std::int64_t f = 0; f < frames; ++f) {
    std::vector<Eigen::Isometry3d> pose(body.segments.size(), Eigen::Isometry3d::Identity());
    for (std::size_t s = 0; s < pose.size(); ++s) {
      const auto& segment = body.segments[s];
      const double side = segment.side == Side::left ? 1.0 : -1.0, phase = 0.1 * static_cast<double>(f);
      const double turn = segment.name.ends_with("thigh")   ? 0.35 * side * std::sin(phase)
                          : segment.name.ends_with("shank") ? -0.4 - 0.3 * side * std::cos(phase)
                                                            : 0.0;
      pose[s].translation() = segment.joint_in_parent;
      pose[s].linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      if (segment.parent >= 0) pose[s] = pose[at(segment.parent)] * pose[s];
    }
    for (const auto& marker : body.markers) {
      const auto column = walk.find(marker.name);
      walk.x(f, column) = pose[at(marker.segment)] * marker.x_in_segment +
                          Eigen::Vector3d(0.01 * static_cast<double>(f), 0.0, 0.0);
      walk.state[walk.index(f, column)] = data::SampleState::measured;
    }
  }
  return walk;
}

}  // namespace kinemark::motion::testing
