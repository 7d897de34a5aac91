// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Simulated limbs for gaps of known truth.
#pragma once

#include <cstdint>

#include "kinemark/data/trajectories.h"

namespace kinemark::testing_support {

/// How a limb moves.
enum class LimbMovement : std::uint8_t {
  rhythm,   ///< one period with three harmonics, as a walk has
  sines,    ///< frequencies that are no multiples of one another
  reaches,  ///< minimum-jerk movements of 0.4 to 1.2 s with rests of 0.3 to 2 s
  start,    ///< at rest for half of the recording, then reaches
  random,   ///< noise below 1.5 Hz
};
inline constexpr int kLimbMovements = 5;

/// Three segments in a chain with four markers on each, which slide on the skin by up to a centimetre with
/// the angle of the joint above; 8 s at 100 Hz, noise of 0.2 to 0.8 mm per axis. Everything is measured.
[[nodiscard]] data::Trajectories moving_limb(LimbMovement movement, std::uint64_t seed);

}  // namespace kinemark::testing_support
