// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What measures of a path are taken of, sample by sample, for figures.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/stages/analysis/path/path_samples.h"
#include "kinemark/stages/analysis/path/timing.h"

namespace kinemark::analysis {

/// A stretch of one marker's path as it was measured: n samples.
struct PathCurves {
  std::string subject;              ///< marker
  std::string region;               ///< name of the stretch; empty: the whole recording
  double rate_hz = 0.0;             ///< above 0
  double start_s = 0.0;             ///< of its first sample, on the recording's clock
  double cut_off_hz = 0.0;          ///< of the smoother, half power
  SeriesMatrix along;               ///< n x 3, position along the principal axes from their mean, m
  Eigen::VectorXd speed;            ///< n, m/s
  Eigen::VectorXd acceleration;     ///< n, tangential: the rate of the speed, m/s^2
  Eigen::VectorXd speed_sd;         ///< n, one standard deviation by refits, m/s; empty without refits
  Eigen::VectorXd acceleration_sd;  ///< n, m/s^2; empty without refits
  std::vector<bool> measured;       ///< n
  MovementWindow window;       ///< onset and end of a discrete movement, s from the first sample; else NaN
  std::vector<double> cycles;  ///< where cycles of a periodic movement begin, s from the first sample
};

/// The rate at which the speed changes, n, m/s^2: the acceleration along the path; 0 where the point rests.
[[nodiscard]] Eigen::VectorXd tangential_acceleration(const PathSamples& path);

/// Sums of curves over refits, for their standard deviations.
class CurveSpread {
 public:
  /// Deviations are taken from this path's curves.
  explicit CurveSpread(const PathSamples& pilot);
  /// One refit of the same stretch.
  void add(const PathSamples& refit);
  /// Standard deviation of the speed about the refits' mean, n, m/s; empty below two refits.
  [[nodiscard]] Eigen::VectorXd speed_sd() const { return deviation(speed_sum_, speed_squares_); }
  /// The same of the tangential acceleration, m/s^2.
  [[nodiscard]] Eigen::VectorXd acceleration_sd() const {
    return deviation(acceleration_sum_, acceleration_squares_);
  }

 private:
  [[nodiscard]] Eigen::VectorXd deviation(const Eigen::VectorXd& sum, const Eigen::VectorXd& squares) const;

  Eigen::VectorXd speed_, acceleration_;
  Eigen::VectorXd speed_sum_, speed_squares_, acceleration_sum_, acceleration_squares_;
  std::int64_t count_ = 0;
};

}  // namespace kinemark::analysis
