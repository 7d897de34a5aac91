// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::motion {

/// A target value with a weight for one coordinate.
struct CoordinateTask {
  std::string coordinate;      ///< name in the model
  double weight = 1.0;         ///< >= 0; see IkOptions for what it weighs against
  double value = 0.0;          ///< rad or m, used when `values` is empty
  std::vector<double> values;  ///< one per solved frame, or empty
};

/// The weight of one marker.
struct MarkerWeight {
  std::string marker;   ///< name in the model
  double weight = 1.0;  ///< >= 0; 0 leaves the marker out
};

/// Weighting of large residuals. huber: linear beyond the scale; cauchy: logarithmic.
enum class Loss : std::uint8_t { square, huber, cauchy };

/// Share of a frame by which a time range may be missed: times are written with few digits.
inline constexpr double kTimeSlack = 0.1;

/// Options of solve_ik().
///
/// The cost of a frame is OpenSim's (Simbody's Markers and QValue goals):
///   ( sum_i w_i |y_i - p_i(q)|^2 ) / ( sum_i w_i )  +  sum_c W_c (q_c - value_c)^2
/// over the markers seen in that frame. Coordinate weights are therefore in m^2 per rad^2 of the mean squared
/// marker error.
struct IkOptions {
  std::vector<MarkerWeight> marker_weights;      ///< markers not listed have default_marker_weight
  double default_marker_weight = 1.0;            ///< >= 0
  std::vector<CoordinateTask> coordinate_tasks;  ///< coordinates held near a value besides
  Loss loss = Loss::square;                      ///< how large residuals are weighed
  double loss_scale_m = 0.02;                    ///< > 0; threshold of huber, scale of cauchy
  bool limits = true;              ///< clamped coordinates stay in their range (free roots excepted)
  double marker_noise_sd_m = 0.0;  ///< per axis; 0: estimated from the residuals as variance components
  bool judge_samples = true;       ///< leave out samples that neither the model nor the frames beside explain
  bool error_bars = true;          ///< compute q_sd and determined
  int max_iterations = 100;        ///< per frame, >= 1
  double first_time_s = -1e300;    ///< solve only frames in [first_time_s, last_time_s]
  double last_time_s = 1e300;      ///< both ends included
  std::uint64_t seed = 1;          ///< of the random starts of the first frame
  int starts = 60;  ///< poses tried on the first frame at most; three equal finds end the search
  int threads = 1;  ///< for the error bars; 0: all cores. Any number gives the same bits.

  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

}  // namespace kinemark::motion
