// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"

namespace kinemark::trajectory {

/// How a gap is filled.
enum class GapMethod : std::uint8_t {
  none,        ///< not at all
  linear,      ///< chord between the samples on either side
  cubic,       ///< spline through 0.3 s on either side (not-a-knot)
  pchip,       ///< monotone cubic (Fritsch & Carlson 1980): never overshoots
  walk,        ///< smoother of an integrated random walk, order and bandwidth by leave-gap-out error
  rigid,       ///< position in the frame of the most rigid neighbours, tied to both ends of the gap
  regression,  ///< regression on the neighbours in that frame, tied to both ends
  pca,         ///< regression on the principal components of all complete markers, tied to both ends
  automatic,   ///< convex combination of all, weights from their errors on artificial gaps: the default
};

/// "none", "linear", "cubic", "pchip", "walk", "rigid", "regression", "pca", "auto".
[[nodiscard]] std::string_view to_string(GapMethod method);
/// The method of that name. The failure lists all names.
[[nodiscard]] Result<GapMethod> parse_gap_method(std::string_view name);

/// Gaps that are looked at; others stay as they are, and out of the account.
struct GapChoice {
  std::int64_t marker = -1;      ///< index of the marker; -1: all of them
  std::int64_t first_frame = 0;  ///< gaps with a frame from here
  std::int64_t last_frame = std::numeric_limits<std::int64_t>::max();  ///< to here, both included
};

/// Options of fill_gaps().
struct GapOptions {
  GapMethod method = GapMethod::automatic;  ///< how all gaps are filled
  double max_gap_s = 2.0;                   ///< longer gaps stay missing; > 0
  double max_sd_m = 0.020;  ///< a gap stays missing when its standard deviation, RMS over the gap and
                            ///< the axes, is larger or unknown; > 0, infinity: fill whatever it is
  double max_extrapolation_s = 0.1;  ///< gaps at the start or end of the recording, where only the marker's
                                     ///< own path can be extrapolated; >= 0
  double noise_sd_m = 0.0;           ///< of a measured sample, per axis; 0: from each marker's own data
  bool check_labels = true;          ///< look for swaps among neighbours and leave those predictors out
  GapChoice only;                    ///< all of them unless it says otherwise
  /// Indices of markers that stay as they are, and that nothing is learned from.
  std::vector<std::int64_t> leave = {};
  std::uint64_t seed = 1;  ///< which artificial gaps are taken when there are more than enough
  int threads = 1;         ///< 0: all cores. Any number gives the same bits.
  Progress progress;       ///< gaps done of all

  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

}  // namespace kinemark::trajectory
