// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Goals between the frames of a recording: position, velocity, acceleration and weight of every marker at any
// time.
//
// The goal is a cubic B-spline with knots at the frames, twice continuously differentiable. Its coefficients
// are the samples under one symmetric kernel: the two-pass Butterworth low-pass and the inverse of the
// B-spline's own smoothing (Unser 1999), cut at the lookahead and corrected so that parabolas pass unchanged.
// The kernel is finite, so a live stream gets the same goals as a file, only later. Beside a gap, or the ends
// of the recording, samples are mirrored through the last one.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "kinemark/data/derivatives.h"

namespace kinemark::motion::internal {

/// 0 up to u = 0, 1 from u = 1 on, a cubic with level ends between.
inline double smooth_step(double u) {
  const double s = std::clamp(u, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

/// The last `capacity` frames of a stream of markers, or all of them.
class SampleWindow {
 public:
  SampleWindow(int markers, std::int64_t capacity);
  /// Samples (3 x M) of the next frame; weight (M) is 0 where a marker is not seen.
  void push(const Eigen::Matrix3Xd& x, const Eigen::VectorXd& weight);
  /// Marks the end of the stream.
  void end() { ended_ = true; }

  [[nodiscard]] bool ended() const { return ended_; }
  [[nodiscard]] std::int64_t frames() const { return frames_; }  ///< pushed so far
  [[nodiscard]] int markers() const { return static_cast<int>(weight_.rows()); }
  /// True when the marker was seen in that frame and the frame is still kept.
  [[nodiscard]] bool present(std::int64_t frame, int marker) const { return weight(frame, marker) > 0.0; }
  [[nodiscard]] double weight(std::int64_t frame, int marker) const;
  [[nodiscard]] Eigen::Vector3d x(std::int64_t frame, int marker) const;

 private:
  Eigen::MatrixXd x_;       // 3M x capacity
  Eigen::MatrixXd weight_;  // M x capacity
  std::int64_t frames_ = 0;
  bool ended_ = false;
};

struct GoalValues {
  explicit GoalValues(int markers);
  Eigen::Matrix3Xd x, v, a;  ///< 3 x M; 0 where the weight is 0
  Eigen::VectorXd weight;    ///< M, >= 0
};

/// Goals from one frame to the next.
class GoalCell {
 public:
  explicit GoalCell(int markers);
  /// At `u` frames after the cell's first frame, in [0, 1].
  void at(double u, GoalValues& out) const;
  /// Accelerations alone (3 x M, m/s^2), also a little beyond the cell's end: there they go on as they change
  /// at it.
  void acceleration_at(double u, Eigen::Matrix3Xd& out) const;

 private:
  friend class GoalFilter;
  double rate_hz_ = 1.0, fade_frames_ = 1.0;
  std::array<Eigen::Matrix3Xd, 6> power_;  // of u
  Eigen::VectorXd weight_;                 // 0: not seen at both ends
  Eigen::VectorXd since_, until_;          // frames to the nearer gap, from u = 0
};

class GoalFilter {
 public:
  /// cutoff_hz 0, or beyond 0.45 of the rate: no low-pass.
  GoalFilter(double rate_hz, double cutoff_hz, double lookahead_s, double fade_s);

  /// Frames after its own that frame f needs before the cell (f - 1, f) is known.
  [[nodiscard]] std::int64_t delay_frames() const;
  /// Frames that a window must keep so that the cell `delay_frames()` ago can be built.
  [[nodiscard]] std::int64_t window_frames() const { return 2 * delay_frames() + 4; }
  /// The cell between frames `first` and `first + 1`.
  void build(const SampleWindow& samples, std::int64_t first, GoalCell& cell) const;
  /// The same from samples whose derivatives are known: quintic through position, velocity and acceleration
  /// at both ends. `marker[m]` and `first_frame` are the indices in `d` of marker m and of frame 0 of the
  /// window.
  void build(const SampleWindow& samples, std::int64_t first, const data::Derivatives& d,
             const std::vector<int>& marker, std::int64_t markers_in_d, std::int64_t first_frame,
             GoalCell& cell) const;
  [[nodiscard]] const std::vector<double>& kernel() const { return kernel_; }
  /// Variance of white noise of variance 1 in a goal at a frame, and in sample minus goal.
  [[nodiscard]] double noise_in_goal() const;
  [[nodiscard]] double noise_in_rest() const;

 private:
  void find_gaps(const SampleWindow& samples, std::int64_t first, GoalCell& cell) const;
  /// Weight of the sample k frames away in a goal at a frame.
  [[nodiscard]] double response(std::int64_t k) const;

  double rate_hz_, fade_frames_;
  std::vector<double> kernel_;  // from the middle outwards
};

}  // namespace kinemark::motion::internal
