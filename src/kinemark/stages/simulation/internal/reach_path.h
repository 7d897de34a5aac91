// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "kinemark/core/random.h"

namespace kinemark::simulation::internal {

/// Where the mouth is from the right shoulder: x forward, y to the left, z up; m.
[[nodiscard]] Eigen::Vector3d mouth_in_world();

/// The wrist of an animal that reaches for food and brings it to its mouth, over and over: one frame after
/// the other, straight minimum-jerk movements of 0.6 to 1.1 s between rests of 0.2 to 0.8 s.
class ReachPath {
 public:
  ReachPath(std::uint64_t seed, double rate_hz);

  /// Wrist in the next frame, m. It may lie beyond the arm's reach.
  Eigen::Vector3d next();

 private:
  void plan();

  Random random_;
  double rate_hz_;
  Eigen::Vector3d from_, to_;
  std::int64_t at_ = 0, moving_ = 0, frames_ = 0;  // frames since the movement began; it lasts; with its rest
  bool to_mouth_ = false;
};

}  // namespace kinemark::simulation::internal
