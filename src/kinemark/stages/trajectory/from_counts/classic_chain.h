// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The processing of 1986 after the look-up table: bridge occlusions, Butterworth filter forwards and
// backwards, two-point differences.
#pragma once

#include <span>
#include <vector>

namespace kinemark::trajectory {

/// Options of the chain of 1986.
struct ClassicChainOptions {
  double cutoff_hz = 12.0;  ///< -3 dB, below half the rate
  /// The cut-off is that of both passes together; false: of each pass, so that 0.80 of it comes out.
  bool cutoff_of_both_passes = true;
};

/// Values where `valid` is 0 replaced by a cubic spline through the others (not-a-knot, over all of them);
/// beyond the first and last valid value the end pieces go on. Unchanged when fewer than four are valid.
[[nodiscard]] std::vector<double> bridge_by_spline(std::span<const double> values,
                                                   std::span<const char> valid);

/// Second-order Butterworth low-pass forwards and backwards, with odd reflection of up to 60 samples at both
/// ends and steady-state starts. Returns the input when it has fewer than four values or the cut-off is at or
/// above 0.99 of Nyquist's frequency.
[[nodiscard]] std::vector<double> butterworth_both_ways(std::span<const double> values, double rate_hz,
                                                        const ClassicChainOptions& options = {});

/// (x[i + 1] - x[i - 1]) rate / 2; one-sided at both ends.
[[nodiscard]] std::vector<double> two_point_difference(std::span<const double> values, double rate_hz);

}  // namespace kinemark::trajectory
