// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/stages/simulation/limb.h"

namespace kinemark::simulation::internal {

/// Streams of random numbers: motion, noise and losses are independent of one another.
enum class LimbStream : std::uint64_t {
  motion = 700,
  noise = 701,
  loss = 702,
  sight = 703,
  skin = 705,
  tip = 706
};

inline constexpr double kMostLimbFrames = 1e7;

[[nodiscard]] Status in_range(const char* name, double value, double low, double high);

/// A chain of segments with n markers each, all samples unset: segments and joints by these names, markers
/// by the names of prefixes and their number in the segment, and `on_last` behind them on the last one.
[[nodiscard]] LimbRecording empty_limb(const std::vector<std::string>& segments,
                                       const std::vector<std::string>& joints,
                                       const std::vector<std::string>& prefixes, int markers_per_segment,
                                       const TimeBase& time, const std::vector<std::string>& on_last = {});

/// Recording from the truth: Gaussian noise on every coordinate, and a share of the samples lost. weight:
/// each frame's losses against that share, empty for 1.
void record_limb(LimbRecording& limb, double noise_sd_m, double missing, std::uint64_t seed,
                 std::span<const double> weight = {});

}  // namespace kinemark::simulation::internal
