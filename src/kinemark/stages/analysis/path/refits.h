// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What noise does to a measure: the path that was found, with new noise, smoothed as the recording was.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/math/noise_model.h"
#include "kinemark/math/smoothing_choice.h"
#include "kinemark/stages/analysis/path/path_samples.h"

namespace kinemark::analysis {

/// Factors on the cut-off of least error: smoothed less, a measure keeps more noise and loses less movement,
/// and what is left of the noise is known from refits.
inline constexpr double kLessSmooth = 1.5;
/// For intervals of third derivatives.
inline constexpr double kLeastSmooth = 2.5;

/// Noise that is not simply white: the most probable model, and models as they may be, one for each refit in
/// turn, at least one.
struct ColouredNoise {
  math::NoiseModel model;               ///< most probable
  std::vector<math::NoiseModel> draws;  ///< in any order
};

/// One recording of a point or of another series and how it is smoothed.
struct Recording {
  SeriesMatrix x;  ///< n x 3, m (a coordinate: n x 1, its unit); missing samples hold any finite number
  std::vector<bool> seen;                      ///< n
  double rate_hz = 0.0;                        ///< above 0
  double noise_sd_m = 0.0;                     ///< per axis, in the unit of x, above 0
  math::SmoothingChoice choice;                ///< of least expected error
  std::shared_ptr<const ColouredNoise> noise;  ///< null: white, of noise_sd_m
  Eigen::MatrixXd noise_shape = {};  ///< symmetric root of the axes' covariance over their mean variance;
                                     ///< empty: all axes alike
};

/// Shape of the noise by what smoothing took away: cameras see depth less well than what lies across, and
/// what is noise out of a plane decides how thick a path looks. Empty where the axes may be
/// alike.
/// @param smooth  of recording.x, kLessSmooth
[[nodiscard]] Eigen::MatrixXd noise_shape(const Recording& recording, const SeriesMatrix& smooth);

/// The recording smoothed with the cut-off of least error times `factor`, at most 0.45 cycles per sample.
[[nodiscard]] SeriesMatrix smoothed(const Recording& recording, double factor);

/// The smoothed path without the energy that noise is expected to have left in it: increments shrunk locally,
/// then principal components, so that it rests where the point rests and lies in a plane where the path does.
/// In movement it is the smoothed path. With coloured noise it is flat where less than six times the energy
/// of noise is seen, and of a recording that was filtered it has back what one more pass of the filter takes
/// away.
/// @param first, count  the stretch that is measured; its mean and components are kept and shrunk
[[nodiscard]] SeriesMatrix pilot_path(const Recording& recording, std::int64_t first, std::int64_t count,
                                      std::uint64_t seed, std::uint64_t stream);

/// Which simulated recordings are made and smoothed.
struct RefitNumbers {
  std::int64_t count = 0;    ///< 0 or more
  std::uint64_t seed = 0;    ///< of their noise
  std::uint64_t stream = 0;  ///< of it
  bool least_too = true;     ///< smooth them with kLeastSmooth as well
  bool noise_too = false;    ///< tell what of the smoothed is noise
  /// Displacements of all samples, as of the path; each refit gets the sum of them with standard normal
  /// factors of its own: what a calibration leaves unknown, which no smoother takes.
  std::vector<SeriesMatrix> displacements;
};

/// Some of them, side by side: columns axes * k and on are those of number first + k.
struct RefitBatch {
  std::int64_t first = 0;  ///< number of the first
  std::int64_t count = 0;  ///< how many
  SeriesMatrix simulated;  ///< n x (axes * count): the path with noise on its seen samples
  SeriesMatrix less;       ///< smoothed with kLessSmooth
  SeriesMatrix least;      ///< with kLeastSmooth; empty where not asked for
  SeriesMatrix noise;      ///< what of `less` is noise; empty where not asked for
};

/// Simulated recordings of `path`, a batch at a time. Noise is white, of the recording's SD, or coloured as
/// the recording has it, on seen samples; a path that was filtered is filtered again with the noise. That of
/// number k comes from stream (stream, k) of the seed, whatever else is computed.
void for_each_batch(const Recording& recording, const SeriesMatrix& path, const RefitNumbers& numbers,
                    const std::function<void(const RefitBatch&)>& visit);

/// For every simulated recording of `path`: call `visit` with its number and with the smoothed path of it at
/// kLessSmooth and kLeastSmooth. Noise as of for_each_batch().
void for_each_refit(const Recording& recording, const SeriesMatrix& path, std::int64_t refits,
                    std::uint64_t seed, std::uint64_t stream,
                    const std::function<void(std::int64_t, const SeriesMatrix&, const SeriesMatrix&)>& visit);

/// Noise of model number k that the smoother at kLessSmooth lets through: variance of a smoothed sample, m^2.
[[nodiscard]] double noise_let_through(const Recording& recording, std::int64_t number);

/// White noise of `sd` added to seen samples, from stream (stream, number) of the seed.
[[nodiscard]] SeriesMatrix with_noise(const SeriesMatrix& path, const std::vector<bool>& seen, double sd,
                                      std::uint64_t seed, std::uint64_t stream, std::int64_t number);

/// Noise of the recording, white or coloured, added to seen samples of a path that is not filtered again.
/// That of number k comes from stream (stream, k) of the seed.
[[nodiscard]] SeriesMatrix with_noise(const SeriesMatrix& path, const Recording& recording,
                                      std::uint64_t seed, std::uint64_t stream, std::int64_t number);

}  // namespace kinemark::analysis
