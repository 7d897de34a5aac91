// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The frames of a limb with the poses that made them.
#pragma once

#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::testing_limbs {

/// All frames, each with its true pose and weights of 1.
[[nodiscard]] inline articulated::PosedFrames true_poses(const RandomChain& limb) {
  articulated::PosedFrames frames;
  for (std::size_t f = 0; f < limb.pose.size(); ++f) {
    frames.frame.push_back(static_cast<std::int64_t>(f));
    frames.pose.push_back(limb.pose[f]);
    frames.weight.emplace_back(static_cast<std::size_t>(limb.chain.markers()), 1.0);
  }
  return frames;
}

}  // namespace kinemark::skeleton::testing_limbs
