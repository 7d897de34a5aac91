// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// When a movement begins, peaks, repeats and ends. Speeds are those of one point, m/s, at even samples; times
// are counted from the first sample, s.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/path/path_samples.h"

namespace kinemark::analysis {

/// Speed, n, m/s.
[[nodiscard]] Eigen::VectorXd speed_of(const PathSamples& path);

/// Share of the peak speed beyond which a point moves.
inline constexpr double kMovingShare = 0.05;
/// How long it must stay beyond it, s.
inline constexpr double kMovingHold_s = 0.1;

/// Where a point is fastest.
struct SpeedPeak {
  double time_s = kNaN;  ///< from the first sample; NaN: there are no samples
  double speed = 0.0;    ///< m/s
};
/// The largest speed, between samples too: velocity is the cubic that has the samples' velocities and
/// accelerations.
/// @param speed  speed_of() the path
[[nodiscard]] SpeedPeak speed_peak(const PathSamples& path, const Eigen::VectorXd& speed);

/// When the speed crosses a level between two neighbouring samples, s from the first sample, by the same
/// cubic. A straight line would be early at an onset and late at an end, where the speed is curved.
/// @param below  sample whose speed is at most the level
/// @param above  sample before or behind it whose speed is above
[[nodiscard]] double crossing_s(const PathSamples& path, std::int64_t below, std::int64_t above,
                                double level);

/// Begin and end of a movement, s from the first sample, between samples by crossing_s().
struct MovementWindow {
  double onset_s = kNaN;  ///< NaN: it moves from the first sample on
  double end_s = kNaN;    ///< NaN: it moves to the last sample
};
/// Movements that rests part from each other, in their order. A point moves beyond kMovingShare of the
/// largest speed and rests where it stays below for kMovingHold_s; shorter stops belong to a movement,
/// shorter movements to a rest. Onset and end are NaN where the samples begin or end within a movement.
/// @param speed  speed_of() the path
[[nodiscard]] std::vector<MovementWindow> movements_of(const PathSamples& path, const Eigen::VectorXd& speed);

/// From the onset of the first of movements_of() to the end of the last one. About 40 ms after the true start
/// of a minimum-jerk reach of 0.7 s.
/// @param speed  speed_of() the path
[[nodiscard]] MovementWindow movement_window(const PathSamples& path, const Eigen::VectorXd& speed);

/// Number of submovements: peaks of the speed above a tenth of the largest that rise a twentieth of it above
/// the higher of the valleys on both sides (prominence).
[[nodiscard]] std::int64_t count_submovements(const Eigen::VectorXd& speed);

/// Duration of the cycles of a periodic movement, s.
struct Cycles {
  double mean_s = kNaN;    ///< NaN: fewer than two crossings
  double sd_s = kNaN;      ///< between cycles; NaN: fewer than three crossings
  std::int64_t count = 0;  ///< whole cycles
};
/// Which straight line is taken off a movement before its cycles are found.
enum class CycleTrend {
  of_samples,      ///< that of least squares: needs no cycles, and has a part of them
  of_whole_cycles  ///< that through the means of whole cycles; of_samples where fewer than two are whole
};
/// Upward crossings of zero of the positions along an axis, freed of a straight trend, s from the first
/// sample.
[[nodiscard]] std::vector<double> cycle_starts(const PathMatrix& x, const Eigen::Vector3d& axis,
                                               double rate_hz, CycleTrend trend);
/// The times between cycle_starts(); crossings nearer to the one before than 0.4 of the median cycle are
/// noise and do not count.
[[nodiscard]] Cycles cycles_along(const PathMatrix& x, const Eigen::Vector3d& axis, double rate_hz);

/// The direction in which positions freed of their straight trend spread most.
[[nodiscard]] Eigen::Vector3d detrended_axis(const PathMatrix& x);

/// Squared amplitudes of positions by frequency, axes added: straight trend taken off, Hann window, samples
/// that are 0 appended until their number is a FourierTransform's good_length().
struct Periodogram {
  double step_hz = 0.0;          ///< from one value to the next; the first is of 0 Hz
  double per_mean_square = 0.0;  ///< what turns a sum of values into a mean square over the samples
  Eigen::VectorXd power;         ///< m^2 times the samples' number squared; empty below 8 samples
  double most_above =
      0.0;  ///< that neither the last nor any above it can exceed; 0: the last is half the rate
};
/// Cost: n log n, less where only low frequencies are asked for.
/// @param highest_hz  up to which, above 0; values within 1e-9 of the largest amplitude
[[nodiscard]] Periodogram periodogram_of(const PathMatrix& x, double rate_hz, double highest_hz = INFINITY);

/// Root of the mean square over the samples, axes added, of what lies between two frequencies, m.
[[nodiscard]] double band_rms(const Periodogram& of, double low_hz, double high_hz);

/// Frequency of the largest value above `low_hz`, Hz, by a parabola through its logarithm and those beside
/// it. NaN where a frequency that was not asked for may have a larger one.
[[nodiscard]] double peak_frequency(const Periodogram& of, double low_hz);

/// Positions without the straight line of least squares through them, axis by axis.
[[nodiscard]] PathMatrix without_trend(const PathMatrix& x);

}  // namespace kinemark::analysis
