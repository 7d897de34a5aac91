// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "kinemark/stages/simulation/internal/sleeve_arm.h"
#include "kinemark/stages/simulation/limb.h"

namespace kinemark::simulation::internal {

/// Slides of the sleeve's LEDs on their bones.
class SleeveSkin {
 public:
  /// @param x_in_segment  of the LEDs, upper arm and forearm, m
  SleeveSkin(const SleeveOptions& options, std::span<const ArmPose> poses,
             std::span<const Eigen::Matrix3Xd> x_in_segment);

  /// Of LED `led` (of both segments, then the tip's), in its segment's axes, m.
  [[nodiscard]] Eigen::Vector3d slide(std::size_t frame, int led) const;

 private:
  Eigen::MatrixXd posture_;              // F x 6, rad: elbow, shoulder, each about its mean; empty: no skin
  std::vector<Eigen::MatrixXd> by_rad_;  // 3 x 6 an LED, m
};

}  // namespace kinemark::simulation::internal
