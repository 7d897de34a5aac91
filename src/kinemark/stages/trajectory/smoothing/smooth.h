// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Smooth positions and differentiate them, with a standard deviation for every number.
// Derivation, sources and what the bars mean: docs/theory/smoothing.md
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/derivatives.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/smoothing/smooth_options.h"

namespace kinemark::trajectory {

/// One filter that was tried: the smaller its criterion, the better.
struct Candidate {
  int order = 0;
  double cutoff_hz = 0.0;  ///< best of this order; savgol: -3 dB of the window
  double criterion = 0.0;  ///< see MarkerAccount::criterion_name
};

/// Power spectral density at some frequencies, summed over the axes.
struct Spectrum {
  std::vector<double>
      frequency_hz;  ///< rising, log-spaced; empty when no stretch without gaps is long enough
  std::vector<double> raw_m2_per_hz;       ///< of what went in (mean of each stretch removed)
  std::vector<double> residual_m2_per_hz;  ///< of what the filter took away
};

/// What was done to one marker, and why.
struct MarkerAccount {
  std::string name;
  data::FilterUsed used;   ///< method, order, cut-off, noise level
  std::string words;       ///< one or two sentences for people
  std::string noise_from;  ///< "given", "covariance", "data", or "" when unknown
  double process_noise =
      0.0;  ///< m^2 / s^(2 order - 1), spectral density of the order-th derivative (kalman, gcv)
  std::string criterion_name;           ///< "SURE, m^2", "GCV, m^2", "" when nothing was chosen
  std::vector<Candidate> candidates;    ///< one per order tried
  double residual_rms_m = 0.0;          ///< in - out over measured samples, per axis; NaN when there are none
  std::vector<double> autocorrelation;  ///< of the residuals, lags 1 to 10 frames; empty when too few samples
  double ljung_box_p =
      1.0;            ///< chance of such autocorrelation in white noise; small: the residual is not white
  bool white = true;  ///< no autocorrelation larger than what the filter itself explains
  /// Standard deviations of position, velocity, acceleration and jerk against what the model alone says: at
  /// seen samples, and for what gaps and ends add. 1 means the model was right.
  double bar_scale[4] = {1.0, 1.0, 1.0, 1.0};
  double gap_bar_scale[4] = {1.0, 1.0, 1.0, 1.0};
  std::int64_t measured = 0, bridged = 0, left_missing = 0;  ///< frames
  std::int64_t bad_variances =
      0;  ///< samples whose variance was not positive and finite: the median was taken
  Spectrum spectrum;
};

struct SmoothResult {
  data::Trajectories trajectories;  ///< as the input, smoothed, with covariance when the noise is known
  data::Derivatives derivatives;
  std::vector<MarkerAccount> markers;  ///< M
};

/// Smooth every marker and find velocity, acceleration and jerk.
///
/// What is missing stays missing, unless `max_bridge_s` asks for more; bridged samples become `interpolated`,
/// made by "kalman" or "gcv". Butterworth, savgol and classic treat the stretches between gaps as separate
/// recordings. Samples are smoothed at their own times (`sample_offset_s`), which the result keeps. Samples
/// that an earlier stage made count as one observation for each stretch. Numbers that cannot be had (velocity
/// of a single sample) are NaN; no gap spreads to its neighbours.
///
/// Fails with bad_input when the trajectories do not validate() or a marker's times do not rise, with usage
/// when options do not check(), with cancelled when `progress` says so. O(F M); the result holds about 31
/// numbers for each marker and frame: for recordings of hours see smooth_each().
[[nodiscard]] Result<SmoothResult> smooth(const data::Trajectories& in, const SmoothOptions& options = {});

/// One marker's part of the result. F frames, in the order of data::Trajectories.
struct MarkerResult {
  std::int64_t marker = 0;
  Array<double> x;           ///< F x 3, m
  Array<double> covariance;  ///< F x 6, m^2; empty when the noise is unknown
  Array<double> velocity, velocity_sd, acceleration, acceleration_sd, jerk, jerk_sd;  ///< F x 3; SDs as above
  Array<data::SampleState> state;                                                     ///< F
  MarkerAccount account;
};

/// The same, marker by marker: `sink` is given each result, in the order of the markers, from the calling
/// thread, and no more than `threads` of them exist at a time. A failure of the sink ends the work and is
/// returned.
[[nodiscard]] Status smooth_each(const data::Trajectories& in, const SmoothOptions& options,
                                 const std::function<Status(MarkerResult&&)>& sink);

}  // namespace kinemark::trajectory
