// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The arm of simulate_sleeve() as it moves, and its LEDs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "kinemark/stages/simulation/internal/reach_path.h"
#include "kinemark/stages/simulation/limb.h"

namespace kinemark::simulation::internal {

/// Pose of the arm in one frame: segment axes have z along the bone, x along the elbow's hinge.
struct ArmPose {
  Eigen::Vector3d elbow, wrist;
  Eigen::Matrix3d world_from_upper_arm, world_from_forearm;
};

/// The arm's poses, one frame after the other. Memory does not grow.
class ArmMotion {
 public:
  explicit ArmMotion(const SleeveOptions& options);
  /// Of the next frame.
  [[nodiscard]] ArmPose next();

 private:
  double rate_hz_;
  ReachPath path_;
  double phase_a_ = 0.0, phase_b_ = 0.0;  // of the slow swivel about the line from shoulder to wrist
  std::int64_t frame_ = 0;
};

/// LEDs of upper arm and forearm in their segments' axes, the tip's last, m.
[[nodiscard]] std::array<Eigen::Matrix3Xd, 2> sleeve_leds(const SleeveOptions& options);

/// Where an LED is, and where it shines.
struct LedInWorld {
  Eigen::Vector3d x, normal;
};
/// @param led  of both segments, then the tip's  @param slide  on its bone, in segment axes, m
[[nodiscard]] LedInWorld led_in_world(const SleeveOptions& options,
                                      const std::array<Eigen::Matrix3Xd, 2>& leds, const ArmPose& pose,
                                      int led, const Eigen::Vector3d& slide);

}  // namespace kinemark::simulation::internal
