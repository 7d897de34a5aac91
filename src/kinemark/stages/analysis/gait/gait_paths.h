// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The markers of walking, smoothed, with z up; and what noise does to them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/math/difference_smoother.h"
#include "kinemark/stages/analysis/gait/bad_samples.h"
#include "kinemark/stages/analysis/gait/gait_markers.h"
#include "kinemark/stages/analysis/gait/gait_noise.h"

namespace kinemark::analysis {

/// Cut-off before the pace of the steps is known; at it a two-pass Butterworth filter of the second order
/// halves the power.
inline constexpr double kFirstCutOff_hz = 8.0;

/// Smoothed paths of one foot, n x 3, m, z up.
struct FootPaths {
  math::SeriesMatrix heel, toe;         ///< 0 rows: the foot has no markers
  std::vector<bool> known;              ///< n; both were measured, or lie within a gap of 0.25 s at most
  FootSet set = FootSet::heel_and_toe;  ///< which markers they are
  bool points = false;                  ///< heel and toe are two markers: the foot points somewhere
  math::SeriesMatrix ankle;             ///< n x 3, outer, as recorded, NaN where not seen; 0 rows: no marker
  math::SeriesMatrix knee;              ///< the same of the knee

  [[nodiscard]] bool present() const { return heel.rows() > 0; }  ///< whether the foot has markers
};

/// Feet and pelvis through a recording of n frames.
struct GaitPaths {
  double rate_hz = 0.0;              ///< above 0
  double start_s = 0.0;              ///< time of the first frame
  std::array<FootPaths, 2> feet;     ///< left, right
  math::SeriesMatrix pelvis;         ///< n x 3
  std::vector<bool> pelvis_known;    ///< n; measured, or within a gap of 1 s at most
  math::SeriesMatrix pelvis_front;   ///< n x 2, from its back to its front, NaN where not measured; 0 rows:
                                     ///< not known
  math::SeriesMatrix pelvis_across;  ///< the same from the right to the left of its front

  [[nodiscard]] std::int64_t frames() const { return pelvis.rows(); }  ///< n
  /// Of one foot.
  [[nodiscard]] const FootPaths& foot(data::Side side) const { return feet[data::index_of(side)]; }
  /// Take a way from all places: n x 2, m.
  void go_back(const math::SeriesMatrix& way);
  /// Seconds on the recording's clock of a frame that need not be whole.
  [[nodiscard]] double time_s(double frame) const { return start_s + frame / rate_hz; }
};

/// Markers whose samples are not all believed, or not all there.
struct FootSeen {
  std::vector<FrameSpan>
      hidden;  ///< stretches longer than 0.25 s without heel or toe, ends included; ascending
  std::vector<FrameSpan> held;  ///< stretches in which a marker did not move by one bit
  std::int64_t leaps = 0;       ///< samples that leap there and back
  double share = 0.0;           ///< of the frames in which both are believed
};

/// Smooths the markers of walking, once as recorded and as often as needed with simulated noise on top.
class GaitSmoother {
 public:
  /// Takes what believe_samples() believes and smooths at kFirstCutOff_hz.
  ///
  /// @param noise_sd_m  per axis, 0: found from each marker's sixth differences
  /// @param up  of length 1, as somebody states it; none: the axis along which the pelvis stands above the
  /// feet
  /// @return  Code::bad_input where the rate is below 20 Hz, or a marker is believed in fewer than 8 frames.
  [[nodiscard]] static Result<GaitSmoother> create(const data::Trajectories& markers,
                                                   const GaitMarkers& which, double noise_sd_m,
                                                   const std::optional<Eigen::Vector3d>& up = {});

  /// Smooth again at another cut-off, at most 0.4 of the rate.
  [[nodiscard]] Status smooth_at(double cut_off_hz);

  [[nodiscard]] const GaitPaths& paths() const { return paths_; }  ///< as recorded
  /// Where the markers are in the laboratory. paths() are the same until set_belt_ahead().
  [[nodiscard]] GaitPaths in_laboratory() const;
  /// From now on take from all paths, but not from noise alone, how far a belt of changing speed is ahead of
  /// an even one: they are those on the even one. n x 2, m, z up.
  void set_belt_ahead(math::SeriesMatrix way);
  /// Find what the samples err by, of whatever colour (GaitNoise). Before, with_noise() takes it as white.
  /// @param threads  0: all cores
  void find_noise(int threads);
  [[nodiscard]] const GaitNoise& noise() const { return noise_; }  ///< that was found; before: nothing
  /// As recorded, with what noise of number `number` leaves after smoothing.
  [[nodiscard]] GaitPaths with_noise(std::uint64_t seed, std::int64_t number) const;
  /// What that noise leaves after smoothing, alone.
  [[nodiscard]] GaitPaths noise_alone(std::uint64_t seed, std::int64_t number) const;
  /// Rotation that turns the recording's axes so that z is up.
  [[nodiscard]] const Eigen::Matrix3d& upright() const { return upright_; }
  /// The laboratory's axis along which the pelvis stands above the feet, in frames in which both are seen.
  [[nodiscard]] Eigen::Vector3d standing() const;
  /// How a foot was seen.
  [[nodiscard]] const FootSeen& seen(data::Side side) const { return seen_[data::index_of(side)]; }
  /// Names of the markers at heel and toe of a foot that is there.
  [[nodiscard]] std::array<std::string, 2> ends_of(data::Side side) const;
  /// Left becomes right, and right left.
  void exchange_sides();
  /// Heel becomes toe, and toe heel.
  void exchange_ends(data::Side side);

 private:
  struct Point {
    std::string name;
    std::int64_t marker = -1;  // whose filter it went through
    math::SeriesMatrix raw;    // zero where not seen
    math::DifferenceSmoother smoother;
    double noise_sd_m = 0.0;
    math::SeriesMatrix smooth;
  };
  [[nodiscard]] static Result<Point> make_point(math::SeriesMatrix raw, std::vector<bool> seen,
                                                double noise_sd_m, const std::string& what);
  [[nodiscard]] std::vector<math::SeriesMatrix> smooth_noise(std::uint64_t seed, std::int64_t number) const;
  [[nodiscard]] Status add_foot(const data::Trajectories& markers, const FootMarkers& foot, data::Side side,
                                double noise_sd_m);
  [[nodiscard]] Status add_pelvis(const data::Trajectories& markers, const GaitMarkers& which,
                                  double noise_sd_m);
  [[nodiscard]] GaitPaths arrange(const std::vector<math::SeriesMatrix>& points) const;

  std::vector<Point> points_;  // one or two of each foot that is there, then the pelvis
  std::array<int, 2> heel_{-1, -1}, toe_{-1, -1};
  std::array<FootSet, 2> set_{};
  std::array<math::SeriesMatrix, 2> ankle_, knee_;  // n x 3 in the recording's axes, or 0 rows
  std::array<std::vector<bool>, 2> known_;
  std::array<FootSeen, 2> seen_;
  std::vector<bool> pelvis_known_;
  math::SeriesMatrix front_, across_;  // n x 3 in the recording's axes, or 0 rows
  Eigen::Matrix3d upright_ = Eigen::Matrix3d::Identity();
  TimeBase time_;
  double stated_sd_m_ = 0.0;
  std::vector<data::FilterUsed> filters_;  // of the recording's markers; empty: nothing says so
  GaitNoise noise_;
  math::SeriesMatrix belt_ahead_;  // n x 2, or 0 rows
  GaitPaths paths_;
};

}  // namespace kinemark::analysis
