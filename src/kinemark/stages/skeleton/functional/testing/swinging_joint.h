// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One joint that swings to and fro in time, with markers that may slide on the moving segment.
#pragma once

#include <cstdint>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton::testing {

struct SwingSetup {
  int movements = 8;
  bool hinge = false;  ///< about x; else about axes that change from movement to movement
  double range_rad = 0.9;
  double noise_sd_m = 0.0005;   ///< per axis
  double own_slide_m = 0.0;     ///< of each marker of the child, per axis and rad
  double common_slide_m = 0.0;  ///< of all of them together
  double joint_slide_m = 0.0;   ///< of the joint itself, along z of the parent, per rad: nothing deforms
  double keeps = 0.0;           ///< of noise from frame to frame, 0 to 1
  std::uint64_t seed = 1;
};

/// 50 frames a second, 2 s a movement, four markers a segment. `centres` holds the bone's joint; segments
/// "s0" and "s1", joint "j0".
[[nodiscard]] TestChain make_swings(const SwingSetup& setup);

}  // namespace kinemark::skeleton::testing
