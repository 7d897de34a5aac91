// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace kinemark::math {

/// H(z) = (b0 + b1 / z + b2 / z^2) / (1 + a1 / z + a2 / z^2).
struct Biquad {
  double b0 = 1.0, b1 = 0.0, b2 = 0.0, a1 = 0.0, a2 = 0.0;  ///< a0 is 1
};

/// Low-pass Butterworth filter as sections of second order, the last one of first order where the order is
/// odd, by the bilinear transform.
/// @param order   1 to 20
/// @param cutoff  -3 dB of one pass, in units of the sampling rate, inside (0, 0.5)
[[nodiscard]] std::vector<Biquad> butterworth_lowpass(int order, double cutoff);

/// Cut-off to design for (units of the sampling rate) so that the filter run forwards and backwards has -3 dB
/// at `cutoff`: tan(pi c') = tan(pi c) / (sqrt(2) - 1)^(1 / (2 order)). Below 0.5 for any cut-off below 0.5.
[[nodiscard]] double two_pass_cutoff(int order, double cutoff);

/// Where a filter of that design cut-off, run both ways, has -3 dB: the inverse of two_pass_cutoff().
[[nodiscard]] double two_pass_half_power(int order, double design_cutoff);

/// |H| of one pass at a frequency in units of the sampling rate.
[[nodiscard]] double amplitude(std::span<const Biquad> sections, double frequency);

/// Run the sections forwards and backwards over x in place: no delay, squared amplitude.
///
/// Both ends are continued by `padding` samples, mirrored through the end point, and the filter starts as if
/// the first value had lasted for ever (Gustafsson's simpler sibling, as in MATLAB's and SciPy's filtfilt).
/// Padding is cut to the number of samples less one; one sample stays as it is. O(n sections). Finite input
/// only.
void filter_both_ways(std::span<const Biquad> sections, int padding, std::vector<double>& x);

/// Padding that SciPy's and MATLAB's filtfilt use: 3 (order + 1).
[[nodiscard]] constexpr int usual_padding(int order) { return 3 * (order + 1); }

}  // namespace kinemark::math
