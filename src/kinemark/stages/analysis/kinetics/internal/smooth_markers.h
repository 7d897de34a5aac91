// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Markers as smoothed paths, and again with new noise.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/stages/analysis/path/marker_noise.h"
#include "kinemark/stages/analysis/path/refits.h"

namespace kinemark::analysis::internal {

/// The markers of a recording as smoothed paths. A marker with fewer than 30 samples, and one that is whole
/// and shows no noise, is taken as it is.
class SmoothMarkers {
 public:
  /// @param used        indices of the markers that are smoothed
  /// @param noise_sd_m  per axis; 0: the markers' covariance where they carry one, else from differences for
  ///                    the choice of the smoother, and for refits from `noise`
  /// @param noise       of the markers, of any colour; null: white
  /// @param threads     0: all cores
  SmoothMarkers(const data::Trajectories& markers, const std::set<std::int64_t>& used, double noise_sd_m,
                const MarkerNoise* noise, int threads);

  /// Positions in all frames, in gaps the most probable ones; states are the recording's.
  [[nodiscard]] const data::Trajectories& paths() const { return paths_; }
  /// The paths with new noise of the markers, smoothed as the recording was. Stream (marker, number).
  [[nodiscard]] data::Trajectories refit(std::uint64_t seed, std::int64_t number) const;

 private:
  void prepare(const data::Trajectories& markers, std::size_t i, double stated);

  data::Trajectories paths_;
  std::vector<std::int64_t> markers_;
  std::vector<Recording> recordings_;  // no samples: taken as it is
  std::vector<std::optional<math::DifferenceSmoother>> smoothers_;
};

}  // namespace kinemark::analysis::internal
