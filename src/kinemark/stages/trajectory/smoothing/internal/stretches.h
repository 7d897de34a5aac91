// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory::smoothing {

/// Frames [begin, end) without a gap.
struct Stretch {
  std::int64_t begin = 0, end = 0;
  [[nodiscard]] std::int64_t length() const { return end - begin; }
};

/// Longest runs of frames that are present, in order.
[[nodiscard]] std::vector<Stretch> stretches(const Array<std::uint8_t>& present);

/// Stretches for choosing a filter: all of them up to 16384 frames in sum, else an even choice of that many.
[[nodiscard]] std::vector<Stretch> sample_of(const std::vector<Stretch>& all);

/// Axis of a stretch as a column.
[[nodiscard]] std::vector<double> column(const Array<double>& x, const Stretch& stretch, int axis);

/// Two-point differences: central inside, one-sided at both ends; NaN for a single value. O(n).
[[nodiscard]] std::vector<double> differences(const std::vector<double>& x, double interval_s);

/// |central difference|^2 of a frequency in units of the rate, s^-2.
[[nodiscard]] double difference_power(double frequency, double interval_s);

/// Butterworth, classic and none. Standard deviations contain the noise that passes the filter, not the
/// movement that it removes. Fails with not_supported when the marker's samples are not evenly spaced.
[[nodiscard]] Status smooth_butterworth(const MarkerSamples& samples, const SmoothOptions& options,
                                        double rate_hz, MarkerResult& result);

/// Local polynomials. Ends of a stretch are the end of its first and last whole window; a stretch shorter
/// than the window is one polynomial. Fails as smooth_butterworth().
[[nodiscard]] Status smooth_savgol(const MarkerSamples& samples, const SmoothOptions& options, double rate_hz,
                                   MarkerResult& result);

}  // namespace kinemark::trajectory::smoothing
