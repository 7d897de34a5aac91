// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The noise of one marker's samples: its colour, and what is not known of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/filter_used.h"
#include "kinemark/math/difference_smoother.h"
#include "kinemark/math/noise_model.h"

namespace kinemark::analysis {

/// How the noise of a marker is known.
enum class NoiseSource : std::uint8_t {
  spectrum,   ///< a model fits the samples' spectrum above the movement
  stated,     ///< the samples' spectrum gives the form, somebody the size
  filter,     ///< the samples say by which filter they were made
  too_short,  ///< white noise is assumed, from sixth differences: too few samples in a row for a spectrum
  no_model,   ///< spikes or noise that changes in time: no model fits, no interval can be given
  rounding,   ///< what is there is the rounding of the file; the noise is below it
};
/// "spectrum", "stated", "filter", "too short", "no model", "rounding".
[[nodiscard]] std::string_view to_string(NoiseSource source);

/// Share of 10 and 90 % of what is drawn.
struct NoiseRange {
  double low = kNaN, middle = kNaN, high = kNaN;  ///< quantiles
};

/// The noise of one marker, in m per axis.
struct PathNoise {
  std::string subject;                          ///< marker
  NoiseSource source = NoiseSource::too_short;  ///< how it is known
  math::NoiseModel model;                       ///< the most probable one; frequencies in cycles per sample
  std::vector<math::NoiseModel> draws;          ///< as it may be, for refits
  double rate_hz = 0.0;                         ///< of the samples
  double stated_sd_m = 0.0;                     ///< what was stated; 0: nothing
  double found_sd_m = kNaN;                     ///< what the samples say by themselves; NaN: nothing
  double rounding_step_m = 0.0;                 ///< of the values; 0: none is seen
  double sample_sd_m = kNaN;  ///< of a sample as it was recorded, behind any filter; NaN: not asked for
  NoiseRange slow_sd_m;       ///< of what lies between 0.2 and 2 Hz, 10, 50 and 90 %
  NoiseRange cutoff_hz;       ///< -3 dB of the filter, 2.5, 50 and 97.5 %; NaN: none
  double above_hz = kNaN;     ///< frequency from which the model describes the samples; NaN: none
  std::int64_t outliers = 0;  ///< samples left out: single frames far from their neighbours

  /// Slow noise that cannot be told from movement: its power is not known within a factor of 2.5.
  [[nodiscard]] bool slow_is_unknown() const;
  /// Low-passed where the movement itself has power, or nobody knows where: what was taken is not in the
  /// data.
  [[nodiscard]] bool filtered_within_movement() const;
  /// Variance of a sample about the mean of `seconds` around it, m^2; with `before`, as it was before a
  /// filter.
  [[nodiscard]] double variance_about_mean(double seconds, bool before) const;
  [[nodiscard]] double sd_m() const { return model.sd(true); }  ///< per axis, before any filter
  /// A low-pass explains the spectrum best.
  [[nodiscard]] bool filtered() const { return model.kind == math::NoiseKind::filtered; }
  /// From sample to sample, by so much that it is worth a word.
  [[nodiscard]] bool correlated() const { return model.correlation > 0.2; }
  /// No interval can rest on it.
  [[nodiscard]] bool unusable() const {
    return source == NoiseSource::no_model || source == NoiseSource::rounding;
  }
};

/// Known beforehand of a marker's noise.
struct NoiseKnown {
  double stated_sd_m = 0.0;                  ///< per axis, before any filter; 0: not stated
  const data::FilterUsed* filter = nullptr;  ///< that the samples went through; null: nothing says so
  std::int64_t draws = 99;                   ///< at least 1
  std::uint64_t seed = 1, stream = 0;        ///< of them
};

/// Single frames that lie far from the cubic through their neighbours while these lie on the other side of
/// theirs, as one wrong sample makes them: what moves does not. Then those beside them that lie as far from
/// what is left, up to six frames away. None where the first are more than 6 % of all.
[[nodiscard]] std::vector<bool> single_frame_outliers(const math::SeriesMatrix& x,
                                                      const std::vector<bool>& seen);

/// Samples to search for the noise: the seen ones without spikes, which lie 8 deviations off
/// (single_frame_outliers takes 5.5), and without samples beside a spike that lie 5.5 off what is left
/// without it.
///
/// Noise with heavy tails has samples between 5.5 and 8. They are left out where they stand against their
/// neighbours, and kept where they go with them: what is left of white noise is then correlated.
[[nodiscard]] std::vector<bool> without_spikes(const math::SeriesMatrix& x, const std::vector<bool>& seen);

/// The step of which all differences of values are multiples, as files round them; 0: there is none.
[[nodiscard]] double rounding_step(const math::SeriesMatrix& x, const std::vector<bool>& seen);

/// The filter that a recording names, as a low-pass of this kind; nothing where its method has another form.
[[nodiscard]] std::optional<math::NoiseModel> low_pass_of(const data::FilterUsed& filter, double rate_hz);

/// Find the noise of a marker's samples (math::find_noise()), or take what is known of it.
/// @param x  n x axes, m, finite
/// @return   nothing where no seven seen samples in a row differ and none is stated
[[nodiscard]] std::optional<PathNoise> find_path_noise(const math::SeriesMatrix& x,
                                                       const std::vector<bool>& seen, double rate_hz,
                                                       const NoiseKnown& known);

}  // namespace kinemark::analysis
