// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The noise of what walking is measured from: feet and pelvis, of whatever colour.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinemark/core/time_base.h"
#include "kinemark/data/filter_used.h"
#include "kinemark/math/difference_smoother.h"
#include "kinemark/stages/analysis/path/marker_noise.h"
#include "kinemark/stages/analysis/path/refits.h"

namespace kinemark::analysis {

/// One point as it was recorded.
struct GaitPointSamples {
  std::string name;                          ///< marker, or "pelvis"
  const math::SeriesMatrix* x = nullptr;     ///< n x 3, m; any finite number where not seen
  const std::vector<bool>* seen = nullptr;   ///< n
  const data::FilterUsed* filter = nullptr;  ///< that it went through; null: nothing says so
};

/// What each point's samples err by, ready to be put on its path again.
struct GaitNoise {
  std::vector<PathNoise> found;      ///< of the points whose samples tell, in their order
  std::vector<Recording> of_points;  ///< of all; x and choice are empty: with_noise() needs neither
  bool stated = false;               ///< somebody said how large it is
  std::vector<std::string> shared;   ///< MarkerNoise::sentences() of the points

  /// How large it is and of which colour, in one sentence; then what readers of intervals must know.
  [[nodiscard]] std::vector<std::string> sentences() const;
};

/// Find the noise of points: by their spectra, sizes that samples leave open from the other points
/// (MarkerNoise). A stated size counts for each point, its spectrum gives the form.
/// @param stated_sd_m  per axis, before any filter; 0: not stated
/// @param threads      0: all cores
[[nodiscard]] GaitNoise find_gait_noise(std::span<const GaitPointSamples> points, const TimeBase& time,
                                        double stated_sd_m, int threads);

}  // namespace kinemark::analysis
