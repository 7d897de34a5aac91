// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/stages/simulation/limb.h"
#include "kinemark/stages/simulation/sleeve_room.h"

namespace kinemark::simulation::internal {

/// Which LEDs of the sleeve the cameras see, one frame after the other.
class SleeveSight {
 public:
  explicit SleeveSight(const SleeveOptions& options);

  /// Set the wrist position of this frame, m; while the hand is at the mouth, LEDs are hidden.
  void begin_frame(const Eigen::Vector3d& wrist);
  /// True when LED `led` (of both segments, then the tip's) at x, shining along this unit vector, is seen.
  [[nodiscard]] bool sees(int led, const Eigen::Vector3d& x, const Eigen::Vector3d& normal) const;

 private:
  double cosine_, mouth_loss_;
  int cameras_;
  SleeveRoom room_ = sleeve_room();
  bool obstacles_;
  std::vector<std::uint8_t> hidden_;  // per LED, by the visit that goes on
  bool at_mouth_ = false, tip_hidden_ = false;
  Random random_, tip_random_;
};

}  // namespace kinemark::simulation::internal
