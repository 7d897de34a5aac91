// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"
#include "kinemark/stages/trajectory/from_counts/bandwidth.h"
#include "kinemark/stages/trajectory/from_counts/smooth_counts.h"

namespace kinemark::trajectory::internal {

/// Motion at one instant, or standard deviations of it.
struct Motion {
  Eigen::Vector3d position, velocity, acceleration;
};

/// The path of one LED through one stretch of frames without a long gap.
class LedPath {
 public:
  /// Frames [first, last) of an LED; `start` has a finite position for each of them.
  LedPath(const data::Counts& counts, const data::Rig& rig, std::int64_t led, std::int64_t first,
          std::int64_t last, const std::vector<Eigen::Vector3d>& start,
          const std::vector<std::uint8_t>& usable, const SmoothCountsOptions& options);

  /// Remove cosine and sine (counts) of the room's flicker from a camera's readings.
  void remove_flicker(int camera, const Eigen::Vector2d& cos_sin);
  /// Passes of smoothing; the last fills result(), with standard deviations.
  void run();

  struct Sample {
    Motion motion, sd;  // sd infinite where nothing is known
    Eigen::Matrix3d covariance;
    bool seen = false;  // by one camera at least
  };
  [[nodiscard]] const std::vector<Sample>& result() const { return result_; }
  [[nodiscard]] const LedFit& fit() const { return fit_; }

 private:
  /// One camera's view of one frame.
  struct View {
    Eigen::Vector4d readings, dt;  // offset and flicker removed; conversion times from the frame's epoch, s
    Eigen::Vector4d keep;          // 0 for a channel at the highest code, 1 for the others
    Eigen::Vector4d phi;           // response at `at`, of kept channels
    Eigen::Matrix<double, 4, 3> d_point;
    Eigen::Vector3d at;
    double variance = 1.0, weight = 1.0, chi2 = 0.0;
    bool usable = false, linear = false;
  };
  [[nodiscard]] View& view(std::size_t frame, std::size_t camera) {
    return views_[frame * cameras_ + camera];
  }
  void linearize(const data::Camera& camera, View& v, const Eigen::Vector3d& x) const;
  void gather(bool weigh);
  void regress_flicker();
  void smooth(bool last);
  void try_without_outliers();
  [[nodiscard]] bool only_flashes();
  void conclude();

  const data::Rig& rig_;
  const SmoothCountsOptions& options_;
  std::size_t frames_, cameras_;
  double epoch_s_ = 0.0;        // after the frame's time: epoch of the states
  std::vector<double> time_s_;  // of each frame
  std::vector<View> views_;
  std::vector<Motion> now_;
  std::vector<LedObservation> observations_;
  Bandwidth bandwidth_;
  bool flashes_ = false;  ///< the bandwidth was chosen without outliers
  std::vector<Eigen::Vector2d> flicker_;
  std::vector<Sample> result_;
  LedFit fit_;
};

}  // namespace kinemark::trajectory::internal
