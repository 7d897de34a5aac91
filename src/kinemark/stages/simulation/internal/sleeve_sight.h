// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/stages/simulation/limb.h"

namespace kinemark::simulation::internal {

/// Which LEDs of the sleeve the cameras see, one frame after the other.
class SleeveSight {
 public:
  explicit SleeveSight(const SleeveOptions& options);

  /// Tell where the wrist is in this frame, m; a visit to the mouth hides LEDs for as long as it lasts.
  void begin_frame(const Eigen::Vector3d& wrist);
  /// Is LED `led` (of both segments) at x, shining along this unit vector, seen?
  [[nodiscard]] bool sees(int led, const Eigen::Vector3d& x, const Eigen::Vector3d& normal) const;

 private:
  double cosine_, mouth_loss_;
  int cameras_;
  bool obstacles_;
  std::vector<std::uint8_t> hidden_;  // per LED, by the visit that goes on
  bool at_mouth_ = false;
  Random random_;
};

}  // namespace kinemark::simulation::internal
