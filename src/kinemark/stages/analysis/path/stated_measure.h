// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What may be said of a measure: its value, which kind of interval is honest, and the remark that belongs to
// it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "kinemark/core/missing.h"
#include "kinemark/data/measure.h"
#include "kinemark/stages/analysis/path/definitions.h"

namespace kinemark::analysis {

/// What all measures of a stretch share.
struct StretchSummary {
  std::string subject;              ///< marker
  std::string region;               ///< its name
  double start_s = kNaN;            ///< first sample, on the recording's clock
  double end_s = kNaN;              ///< last sample
  double share_not_measured = 0.0;  ///< of its samples
  double longest_gap_s = 0.0;       ///< in it
  double below_noise = 0.0;  ///< times the noise by which it moves about its slow trend at most; 0: by more
  double noise_sd_m = 0.0;   ///< per axis
  std::string no_noise;      ///< why no interval can rest on the noise; empty: it can
  bool slow_noise_unknown =
      false;  ///< noise below 2 Hz cannot be told from movement: from `slow_low_m` to `slow_high_m`
  double slow_low_m = kNaN;      ///< of that noise
  double slow_high_m = kNaN;     ///< of that noise
  bool correlated = false;       ///< the noise, from sample to sample
  bool filtered_within = false;  ///< low-passed within the movement's band
  double filtered_hz = kNaN;     ///< -3 dB of the filter that it went through; NaN: none
  std::string velocity_jumps;    ///< when, where the velocity jumps; empty: it does not
  bool peak_at_jump = false;     ///< within 0.1 s of such a jump the speed is largest
  double cut_off_hz = kNaN;      ///< of least expected error
  int order = 0;                 ///< of the smoother
  double level = 0.95;           ///< of the intervals
  std::int64_t refits = 0;       ///< behind them; 0: no intervals
};

/// What a fit makes of a measure that lets the movement start and stop sharply, which a smoother rounds off.
struct SharpValue {
  double value = kNaN;  ///< NaN: only what it can be at most is known
  double low = kNaN;    ///< of its interval; NaN: there is none
  double high = kNaN;   ///< of its interval; NaN: there is none
};

/// Numbers of one measure. Deviations as Pivot says, of squares where it says so.
struct MeasureNumbers {
  double estimate = kNaN;              ///< of the path smoothed with kLessSmooth, or unsmoothed
  double estimate_of_interval = kNaN;  ///< of that with kLeastSmooth, where the interval comes from it
  std::span<const double> deviations;  ///< of the refits
  std::span<const double> deviations_of_interval;  ///< of those with kLeastSmooth
  bool thinned = false;                            ///< estimate and deviations are of thinned_extremes()
  /// Spread of the deviations among the third of refits with most noise over that with least.
  double doubt = 1.0;
  SharpValue sharp;  ///< of a discrete movement, where there is one
};

/// Longest gap across which intervals were tried; there is none beyond it, s.
inline constexpr double kLongestGap_s = 0.2;

/// A measure with all that belongs to it; valid by Measure::validate().
[[nodiscard]] data::Measure state_measure(const PathDefinition& definition, const StretchSummary& stretch,
                                          const PathFrame& frame, const MeasureNumbers& numbers);

}  // namespace kinemark::analysis
