// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The markers of walking, smoothed, with z up; and what noise does to them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/math/difference_smoother.h"
#include "kinemark/stages/analysis/gait/gait_markers.h"

namespace kinemark::analysis {

/// Low-pass of the published methods: gain 1/2 at this frequency, as a second-order Butterworth filter run
/// both ways has it (O'Connor et al. 2007).
inline constexpr double kGaitCutOff_hz = 7.0;

/// Smoothed paths of one foot, n x 3, m, z up.
struct FootPaths {
  math::SeriesMatrix heel, toe;  ///< 0 rows: the foot has no markers
  std::vector<bool> known;       ///< n; false farther than 0.1 s from a frame in which both were measured

  [[nodiscard]] bool present() const { return heel.rows() > 0; }  ///< whether the foot has markers
};

/// Feet and pelvis through a recording of n frames.
struct GaitPaths {
  double rate_hz = 0.0;           ///< above 0
  double start_s = 0.0;           ///< time of the first frame
  std::array<FootPaths, 2> feet;  ///< left, right
  math::SeriesMatrix pelvis;      ///< n x 3; 0 rows: not known
  math::SeriesMatrix forward;     ///< n x 2; horizontal direction that the feet point to, length 1

  [[nodiscard]] std::int64_t frames() const { return forward.rows(); }  ///< n
  /// Of one foot.
  [[nodiscard]] const FootPaths& foot(data::Side side) const { return feet[data::index_of(side)]; }
  /// Seconds on the recording's clock of a frame that need not be whole.
  [[nodiscard]] double time_s(double frame) const { return start_s + frame / rate_hz; }
};

/// Smooths the markers of walking, once as recorded and as often as needed with simulated noise on top.
class GaitSmoother {
 public:
  /// @param noise_sd_m  per axis, 0: found from each marker's sixth differences
  /// @return  Code::bad_input where the rate is below 20 Hz, a marker was measured in fewer than 20 frames,
  /// or
  ///          nobody can tell which way is up.
  [[nodiscard]] static Result<GaitSmoother> create(const data::Trajectories& markers,
                                                   const GaitMarkers& which, double noise_sd_m);

  [[nodiscard]] const GaitPaths& paths() const { return paths_; }  ///< as recorded
  /// As recorded, with what noise of stream (1, number) of the seed leaves after smoothing.
  [[nodiscard]] GaitPaths with_noise(std::uint64_t seed, std::int64_t number) const;
  /// Rotation that turns the recording's axes so that z is up.
  [[nodiscard]] const Eigen::Matrix3d& upright() const { return upright_; }

 private:
  struct Point {
    math::DifferenceSmoother smoother;
    double noise_sd_m = 0.0;
    math::SeriesMatrix smooth;
  };
  [[nodiscard]] static Result<Point> smooth_point(const data::Trajectories& markers,
                                                  const std::vector<std::int64_t>& of, double noise_sd_m);
  [[nodiscard]] GaitPaths arrange(const std::vector<math::SeriesMatrix>& points) const;

  std::vector<Point> points_;  // heel and toe of each foot that is there, then the pelvis if it is
  std::array<int, 2> heel_{-1, -1};
  int pelvis_ = -1;
  std::array<std::vector<bool>, 2> known_;
  Eigen::Matrix3d upright_ = Eigen::Matrix3d::Identity();
  TimeBase time_;
  GaitPaths paths_;
};

}  // namespace kinemark::analysis
