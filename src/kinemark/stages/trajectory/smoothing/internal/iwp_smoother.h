// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kinemark::trajectory::smoothing {

/// Samples of one marker or one axis, borrowed.
struct Series {
  std::int64_t frames = 0;
  int axes = 1;                        ///< 1 to 3, with the same variance and the same gaps
  const double* y = nullptr;           ///< frames x axes
  const std::uint8_t* seen = nullptr;  ///< frames; 0 where there is no sample
  const double* variance = nullptr;  ///< frames, of samples that are seen, in units of the noise; null: all 1
  const double* time_s = nullptr;    ///< frames, rising; null: every interval_s
  double interval_s = 0.0;           ///< > 0, nominal time between samples

  /// Frames [begin, begin + count).
  [[nodiscard]] Series part(std::int64_t begin, std::int64_t count) const;
  [[nodiscard]] double seconds_between(std::int64_t earlier, std::int64_t later) const;
};

/// Where smooth_series() writes, or null: frames x axes x 4 (position, velocity, acceleration, jerk) and
/// frames x 4 (their variances in noise units, the same for all axes). NaN where there is no estimate.
struct SmoothedOut {
  double* state = nullptr;
  double* variance = nullptr;
};

/// What choosing a filter needs to know about a run of it.
struct Scores {
  double rss = 0.0;         ///< squared residuals over their variances
  double trace = 0.0;       ///< of the matrix that turns samples into smoothed positions
  std::int64_t values = 0;  ///< samples times axes
};

/// Fixed-interval smoother of the `order` times integrated Wiener process (2 to 5), -3 dB at cutoff_hz where
/// samples are even. Gaps are smoothed across; stretches between which nothing of use reaches are smoothed
/// apart and NaN lies between them. O(frames) time; scratch memory does not grow with frames where gains
/// settle, and never beyond some MB.
Scores smooth_series(const Series& series, int order, double cutoff_hz, const SmoothedOut& out);

}  // namespace kinemark::trajectory::smoothing
