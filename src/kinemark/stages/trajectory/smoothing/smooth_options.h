// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"

namespace kinemark::trajectory {

/// How positions are smoothed and differentiated.
enum class FilterMethod : std::uint8_t {
  none,         ///< positions as they are, two-point differences
  kalman,       ///< RTS smoother of an integrated Wiener process, order and bandwidth by SURE: the default
  butterworth,  ///< zero-phase, two-point differences
  gcv,          ///< smoothing spline, smoothness by generalised cross-validation
  savgol,       ///< local polynomials (Savitzky & Golay), window by generalised cross-validation
  classic,      ///< the chain of 1986: Butterworth of order 2 run twice at 12 Hz, cut-off not corrected
};

/// "none", "kalman", "butterworth", "gcv", "savgol", "classic".
[[nodiscard]] std::string_view to_string(FilterMethod method);
/// The method of that name; "auto" is kalman. The failure lists all names.
[[nodiscard]] Result<FilterMethod> parse_filter_method(std::string_view name);

/// How a Butterworth filter finds its cut-off when none is given.
enum class CutoffRule : std::uint8_t {
  winter,   ///< residual analysis (Winter 2009): where the residual equals that of noise alone
  challis,  ///< the residual is as white as it gets (Challis 1999)
};

[[nodiscard]] std::string_view to_string(CutoffRule rule);  ///< "winter", "challis"
/// The rule of that name; the failure lists all names.
[[nodiscard]] Result<CutoffRule> parse_cutoff_rule(std::string_view name);

/// Options of smooth().
struct SmoothOptions {
  FilterMethod method = FilterMethod::kalman;  ///< how positions are smoothed
  /// kalman: times that noise is integrated, 2 to 5; gcv: half order of the spline, 2 to 5 (3 quintic, 4
  /// heptic, 5 nonic); butterworth: order of one pass, even, 2 to 10; savgol: degree, 1 to 7. 0: found from
  /// the data (kalman, gcv), else 2 (butterworth) and 4 (savgol). Classic has 2 and no choice.
  int order = 0;
  double cutoff_hz = 0.0;  ///< -3 dB of the whole filter, below half the rate; 0: found from the data
                           ///< (classic: 12 Hz)
  CutoffRule cutoff_rule = CutoffRule::winter;  ///< butterworth with cutoff_hz = 0
  bool correct_cutoff = true;  ///< butterworth: the two passes together have the cut-off that was asked;
                               ///< false is what filtfilt of other programs does (0.80 of it at order 2)
  double noise_sd_m = 0.0;  ///< per axis; 0: from the data, covariances (where there are some) giving weights
  double max_bridge_s = 0.0;       ///< kalman and gcv: also fill gaps inside up to this long; 0: none
  double max_bridge_sd_m = 0.010;  ///< ... but leave missing what would have a larger SD per axis
  /// Indices of markers that stay as they are: FilterMethod::none, whatever the others are smoothed by.
  std::vector<std::int64_t> leave = {};
  int threads = 1;    ///< 0: all cores. Any number gives the same bits.
  Progress progress;  ///< markers done of all

  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check(double rate_hz) const;
};

}  // namespace kinemark::trajectory
