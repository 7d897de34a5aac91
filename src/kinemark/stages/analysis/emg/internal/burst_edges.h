// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// When bursts begin and end, as draws of what their power allows.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/stages/analysis/emg/internal/power_levels.h"

namespace kinemark::analysis {

/// One edge of a burst, in the bins of the channel.
struct BurstEdge {
  std::int64_t bin = 0;    ///< where levels put it: the first active bin, or that behind the last
  bool is_onset = true;    ///< else an end
  std::int64_t quiet = 0;  ///< bins on its quiet side that are its own
  std::int64_t burst = 0;  ///< bins on its active side that are its own
};

/// Draws of the instants of all edges, in bins: D of E each. A burst begins with a step or a rise of 10 ms to
/// 0.64 s, linear or half a cosine; all edges of a channel rise alike, as what one edge could tell of
/// another's shape is the same at all of them and does not average out. The band's filter spreads power over
/// neighbouring bins, by `spread`.
/// @param levels  power of the level in each bin
/// @param spread  2 R + 1 weights, sum 1
/// @param bin_s   length of a bin
[[nodiscard]] std::vector<std::vector<double>> draw_edges(const std::vector<BurstEdge>& edges,
                                                          const std::vector<double>& power,
                                                          const std::vector<double>& levels, double rest,
                                                          double freedom, const std::vector<double>& spread,
                                                          double bin_s, std::int64_t draws,
                                                          std::uint64_t seed);

}  // namespace kinemark::analysis
