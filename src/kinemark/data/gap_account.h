// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"

namespace kinemark::data {

/// Error of one method of filling on the artificial gaps, and its weight in the fill.
struct GapWeight {
  std::string name;      ///< "cubic", "walk", "regression, tied", ...
  double weight = 0.0;   ///< >= 0; all weights of a gap sum to 1
  double rms_m = kNaN;   ///< 3D distance, RMS over the artificial gaps; NaN when there were none
  bool guarded = false;  ///< left out: deviates from all others by more than its own errors allow
};

/// One gap of one marker, filled or not. A gap whose predictors change on the way is one account per piece.
struct GapAccount {
  std::int64_t marker = 0;       ///< index into the recording's markers
  std::int64_t first_frame = 0;  ///< both ends belong to the gap
  std::int64_t last_frame = 0;   ///< both ends belong to the gap
  bool at_edge = false;          ///< touches the start or the end of the recording
  bool filled = false;           ///< false: `why_open` says why
  bool temporal = false;         ///< filled from the marker's own path alone
  std::string method;            ///< as in Trajectories::methods, "auto" for a combination; "" when left open
  std::vector<GapWeight> weights;       ///< largest first
  double sd_m = kNaN;                   ///< predicted, per axis, RMS over the gap; NaN when unknown
  double max_sd_m = kNaN;               ///< the largest along the gap and over the axes; NaN when unknown
  int windows = 0;                      ///< artificial gaps that weights and SD come from
  double window_s = 0.0;                ///< their length; shorter than the gap in short recordings
  std::vector<std::string> predictors;  ///< markers that the fill is predicted from, most rigid first
  std::vector<std::string> dropped;     ///< markers left out: not where they usually are in the gap
  std::string why_open;                 ///< a sentence when the gap was left open, else ""

  /// Length of the gap.
  [[nodiscard]] std::int64_t frames() const { return last_frame - first_frame + 1; }
};

}  // namespace kinemark::data
