// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What stands about the arm of simulate_sleeve(), in its axes.
#pragma once

#include <Eigen/Core>
#include <array>

namespace kinemark::simulation {

/// A ball, m.
struct SleeveBall {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// Cameras, mouth and body, m; the right shoulder is the origin, x forward, y to the left, z up.
struct SleeveRoom {
  std::array<Eigen::Vector3d, 6> cameras;  ///< their lenses
  Eigen::Vector3d mouth;
  SleeveBall head, trunk;
};
[[nodiscard]] SleeveRoom sleeve_room();

}  // namespace kinemark::simulation
