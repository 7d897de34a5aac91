// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Noise of any colour, by four forms of its spectrum. Frequencies are cycles per sample.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kinemark::math {

/// What the noise of recorded samples is like.
enum class NoiseKind : std::uint8_t {
  white,                 ///< each sample by itself
  correlated,            ///< autoregressive of first order
  correlated_and_white,  ///< the same and white noise on top
  filtered,              ///< white before a low-pass that the movement went through as well
};
/// "white", "correlated", "correlated and white", "filtered".
[[nodiscard]] std::string_view to_string(NoiseKind kind);

/// Low-passes without delay.
enum class LowPass : std::uint8_t {
  butterworth,  ///< forwards and backwards
  spline,       ///< smoothing spline of degree 2 order - 1 (GCVSPL, DifferenceSmoother)
};
/// "Butterworth filter of order 2, both ways", "quintic spline", ...
[[nodiscard]] std::string name_of(LowPass form, int order);

/// What is left of an amplitude. Both halve it at `half`: 1 / (1 + (g(f) / g(half))^(2 order)) with g the
/// tangent of pi f for Butterworth's, and for the spline (2 sin pi f)^2m / ((2 pi half)^2m B(f)), B the
/// transform of the cardinal B-spline of order 2m at the integers.
[[nodiscard]] double gain_of(LowPass form, int order, double half, double frequency);
/// g(f)^(2 order) of gain_of(), and of the cut-off: gain = 1 / (1 + these / those).
[[nodiscard]] double roll_off(LowPass form, int order, double frequency);
[[nodiscard]] double roll_off_at_half(LowPass form, int order, double half);  ///< see roll_off()
/// Where the filter has -3 dB of the frequency where it halves, and the other way round.
[[nodiscard]] double three_db_of_half(LowPass form, int order, double half);
[[nodiscard]] double half_of_three_db(LowPass form, int order, double three_db);  ///< its inverse

/// The spectrum H(f)^2 variance C(f) + floor, C = (1 - rho^2) / |1 - rho z|^2; a mean square per sample, so
/// that white noise has its variance at all frequencies.
struct NoiseModel {
  NoiseKind kind = NoiseKind::white;    ///< which of the terms there are
  LowPass form = LowPass::butterworth;  ///< of the filter
  int order = 0;                        ///< of the filter; 0: there is none
  double variance = 0.0;                ///< before any filter, per axis
  double correlation = 0.0;             ///< rho, from sample to sample
  double half = 0.0;                    ///< frequency whose amplitude the filter halves
  double floor = 0.0;                   ///< variance of white noise on top, such as rounding

  [[nodiscard]] double before_filter(double frequency) const;  ///< variance C(f) + floor
  [[nodiscard]] double gain(double frequency) const;           ///< H(f); 1 without a filter
  [[nodiscard]] double power(double frequency) const;          ///< the spectrum
  /// Standard deviation of a sample, by the spectrum; with `before`, as it was before the filter.
  [[nodiscard]] double sd(bool before = false) const;
};

}  // namespace kinemark::math
