// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What single samples of a recording's markers err by, for what is computed from samples as they are.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/stages/analysis/path/path_noise.h"

namespace kinemark::analysis {

/// The noise of a recording's markers, of whatever colour, each by its own spectrum. What a marker's samples
/// leave open of its size, the recording's other markers say: sizes lie about a common one (random effects).
class MarkerNoise {
 public:
  /// Find the noise of markers. Without seven samples in a row that differ, none is known of a marker.
  /// @param which    indices of the markers
  /// @param seed     of the models that are drawn, the same for any number of threads
  /// @param threads  0: all cores
  /// Cost: some 5 ms a marker.
  [[nodiscard]] static MarkerNoise find(const data::Trajectories& markers,
                                        const std::set<std::int64_t>& which, std::uint64_t seed, int threads);

  /// Standard deviation of a sample, m per axis: of the noise that is in the recording, behind any filter.
  /// 0 where samples show none; NaN where nothing is known, and of markers that were not asked for.
  [[nodiscard]] double sample_sd_m(std::int64_t marker) const;
  /// null: no noise is known.
  [[nodiscard]] const PathNoise* of(std::int64_t marker) const;
  /// Of all markers whose noise is known, in the recording's order; each has its PathNoise::sample_sd_m.
  [[nodiscard]] const std::vector<PathNoise>& all() const { return noises_; }
  /// What readers of the deviations must know: once for all markers that share it. Of white noise that was
  /// found there is nothing to say.
  [[nodiscard]] std::vector<std::string> sentences() const;

 private:
  struct Marker {
    std::int64_t index = 0;     // in the recording
    std::ptrdiff_t noise = -1;  // in noises_; -1: none is known
    double sample_sd_m = 0.0;
  };
  [[nodiscard]] const Marker* find_marker(std::int64_t index) const;

  std::vector<PathNoise> noises_;
  std::vector<Marker> markers_;  // by their indices
};

/// The samples of a marker leave open how large its noise is: it may be slower than what can be told from
/// movement, fits no model, lies below the rounding of the file, or has too few samples in a row.
[[nodiscard]] bool leaves_size_open(const PathNoise& noise);

}  // namespace kinemark::analysis
