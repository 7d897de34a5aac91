// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Still observations of a tree and of grids before a known rig, for the tests of this folder.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kinemark/stages/calibration/still_poses.h"
#include "support/lateral_rig.h"

namespace kinemark::calibration {

inline std::vector<Eigen::Vector3d> test_tree() { return tree_from_sides({0.533, 0.310, 0.310}).value(); }

/// The tree in `poses` poses, ten frames averaged.
inline StillPoses tree_observations(const data::Rig& truth, int poses, std::uint64_t seed,
                                    std::vector<Eigen::Matrix3Xd>* where = nullptr) {
  StillPoses out{.tree = test_tree(), .cameras = truth.camera_count(), .observations = {}};
  Random random(seed, 5);
  const double sd = testing_support::count_sd(truth) / std::sqrt(10.0);
  for (int pose = 0; pose < poses; ++pose) {
    const double x = random.uniform(-0.3, 0.3), y = random.uniform(-0.35, 0.35),
                 z = random.uniform(-0.3, 0.3);
    const double yaw = random.uniform(-0.6, 0.6), pitch = random.uniform(-0.6, 0.6),
                 roll = random.uniform(-3.1, 3.1);
    const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()) *
                                      Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()))
                                         .toRotationMatrix();
    Eigen::Matrix3Xd positions(3, out.leds());
    for (int led = 0; led < out.leds(); ++led) {
      positions.col(led) = rotation * out.tree[static_cast<std::size_t>(led)] + Eigen::Vector3d(x, y, z);
      for (const auto& camera : truth.cameras) {
        StillObservation s{testing_support::mean_counts(camera, positions.col(led)), sd * sd};
        for (double& count : s.counts) count += sd * random.gaussian();
        out.observations.push_back(s);
      }
    }
    if (where != nullptr) where->push_back(positions);
  }
  return out;
}

/// A grid square before each camera, 0.5 mm placement error, 50 samples.
inline std::vector<GridObservations> grid_observations_of(const data::Rig& truth, std::uint64_t seed) {
  Random board(seed, 6);
  std::vector<Eigen::Vector2d> shift(225);
  for (auto& s : shift) s = 0.5e-3 * Eigen::Vector2d{board.gaussian(), board.gaussian()};
  std::vector<GridObservations> out;
  Random random(seed, 7);
  const double sd = testing_support::count_sd(truth) / std::sqrt(50.0);
  for (const auto& camera : truth.cameras) {
    GridObservations grid;
    for (int node = 0; node < 225; ++node) {
      const Eigen::Vector2d position =
          grid.position_m(node / 15, node % 15) + shift[static_cast<std::size_t>(node)];
      const Eigen::Vector3d x =
          camera.cam_from_world.inverse() * Eigen::Vector3d(position.x(), position.y(), grid.distance_m);
      StillObservation s{testing_support::mean_counts(camera, x), sd * sd};
      for (double& count : s.counts) count += sd * random.gaussian();
      grid.observations.push_back(s);
    }
    out.push_back(std::move(grid));
  }
  return out;
}

}  // namespace kinemark::calibration
