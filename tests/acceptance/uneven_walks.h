// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Walkers whose steps differ from one to the next by a known amount.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::acceptance {

/// One step of a foot on the ground.
struct UnevenStep {
  double strike_s = 0.0, off_s = 0.0;
  Eigen::Vector2d heel;  ///< along the way and to its left, where it stands, m
};

/// A walk, and what is true of it.
struct UnevenWalk {
  std::array<std::vector<UnevenStep>, 2> steps;  ///< left, right
  data::Trajectories markers;                    ///< "LHEE", "LTOE", "RHEE", "RTOE", "SACR"
  double stride_sd_s = 0.0, width_sd_m = 0.0;    ///< of endlessly many steps of this walker
};

/// "shifted": the known walker, its time warped and each of its steps shifted sideways, independently.
/// "planned": feet that go from print to print of a plan, whose durations, lengths and widths each depend on
/// those of the step before.
[[nodiscard]] UnevenWalk uneven_walk(const std::string& kind, std::uint64_t seed);

}  // namespace kinemark::acceptance
