// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/derivatives.h"

namespace kinemark::data {

/// One filter that was tried: the smaller its criterion, the better.
struct FilterCandidate {
  int order = 0;            ///< of the filter
  double cutoff_hz = kNaN;  ///< best of this order; savgol: -3 dB of the window
  double criterion = kNaN;  ///< see MarkerAccount::criterion_name
};

/// Power spectral density at some frequencies, summed over the axes. All three have one length, or are empty
/// when no stretch without gaps is long enough.
struct Spectrum {
  std::vector<double> frequency_hz;        ///< rising, > 0, log-spaced
  std::vector<double> raw_m2_per_hz;       ///< of what went in (mean of each stretch removed)
  std::vector<double> residual_m2_per_hz;  ///< of what the filter took away
};

/// What smoothing did to one marker, and why.
struct MarkerAccount {
  std::string name;         ///< of the marker
  FilterUsed used;          ///< method, order, cut-off, noise level
  std::string description;  ///< one or two sentences for people: what the filter did and why it was chosen
  std::string noise_from;   ///< "given", "covariance", "data", or "" when unknown
  double process_noise =
      0.0;  ///< m^2 / s^(2 order - 1), spectral density of the order-th derivative (kalman, gcv)
  std::string criterion_name;               ///< "SURE, m^2", "GCV, m^2", "" when nothing was chosen
  std::vector<FilterCandidate> candidates;  ///< one per order tried
  double residual_rms_m = kNaN;  ///< in - out over measured samples, per axis; NaN when there are none
  std::vector<double>
      autocorrelation;  ///< of the residuals, lags 1, 2, ... frames; empty when too few samples
  /// The same as this filter makes of white noise; empty without a filter or when too few samples.
  std::vector<double> white_autocorrelation;
  /// Chance of so uneven a spectrum of the residual if the noise is white, the filter's own part accounted
  /// for (Bartlett's cumulative periodogram); NaN: not judged.
  double white_p = kNaN;
  /// Share of the noise power at other frequencies than that of white noise, -1 to 1; > 0: too much at low
  /// ones; NaN: not judged.
  double white_departure = kNaN;
  /// Standard deviations of position, velocity, acceleration and jerk against what the model alone says: at
  /// seen samples, and for what gaps and ends add. 1 means the model was right.
  std::array<double, 4> bar_scale{1.0, 1.0, 1.0, 1.0};
  std::array<double, 4> gap_bar_scale{1.0, 1.0, 1.0, 1.0};   ///< likewise, for what gaps and ends add
  std::int64_t measured = 0, bridged = 0, left_missing = 0;  ///< frames
  std::int64_t bad_variances =
      0;              ///< samples whose variance was not positive and finite: the median was taken
  Spectrum spectrum;  ///< of the marker's samples

  /// Whether the residual could be tested for whiteness.
  [[nodiscard]] bool judged() const { return white_p >= 0.0; }
  /// The residual was tested, and white noise is ruled out at the level of 1 %.
  [[nodiscard]] bool coloured() const { return white_p < 0.01; }
};

}  // namespace kinemark::data
