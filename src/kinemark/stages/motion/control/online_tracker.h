// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/control/track_options.h"

namespace kinemark::motion {

/// One frame of a live stream; numbers as in data::JointMotion, n coordinates each.
struct LivePose {
  std::int64_t frame = 0;           ///< number of the frame, from 0
  double time_s = 0.0;              ///< of the frame
  Eigen::VectorXd q, qd, qdd, tau;  ///< coordinates (rad, m), their rates and accelerations, forces (N m, N)
  Eigen::VectorXd q_sd, q_bound;    ///< NaN where not determined; empty without error bars
  std::vector<std::uint8_t> determined;  ///< empty without error bars
  std::vector<int> left_out;       ///< markers, by their place in the stream, whose sample was not believed
  int rank = 0;                    ///< directions of motion that the markers hold
  double smallest_singular = 0.0;  ///< as TrackResult, kg^-1/2
  data::FrameStatus status = data::FrameStatus::no_markers;  ///< how well the frame was followed
  Eigen::Matrix3Xd goal;  ///< of each marker of the stream, m; NaN where the body follows none
  /// Coordinates (rad, m) of the body that is pushed, which are no measurement; empty while nobody pushes it
  /// and once it is back. All that is above knows nothing of it.
  Eigen::VectorXd pushed_q;
  double pushed_m = 0.0;  ///< how far the push has moved a marker of the model at most, m
};

/// track_markers() on a stream: poses are returned `delay_frames()` after their frames, with the same numbers
/// (q, qd, qdd, tau) as from a file, provided that the first frame shows 95 % of the markers and that the
/// same coordinates are locked. Standard deviations and bounds hold the noise of the goals, and agree with
/// those of a file to rounding when the marker noise is given; otherwise it is estimated from the frames so
/// far. What the filter takes away from the movement (TrackResult::filter_sd) is known of files only: where
/// that is large beside the noise, deviations of a stream are too small.
///
/// The delay is the lookahead of the goals' filter, TrackOptions::lookahead_s, or the fading time where that
/// is longer; a shorter lookahead reduces the delay and filters less well. Memory use is constant.
class OnlineTracker {
 public:
  /// @param markers  names in the order in which frames will come
  /// @param rate_hz  of the stream, in (0, 10000]
  static Result<OnlineTracker> create(const model::Model& model, const std::vector<std::string>& markers,
                                      double rate_hz, const TrackOptions& options = {});
  OnlineTracker(OnlineTracker&&) noexcept;             ///< takes a running tracker over
  OnlineTracker& operator=(OnlineTracker&&) noexcept;  ///< replaces this one by another
  OnlineTracker(const OnlineTracker&) = delete;
  OnlineTracker& operator=(const OnlineTracker&) = delete;
  ~OnlineTracker();

  [[nodiscard]] std::int64_t delay_frames() const;  ///< frames that must have come before a pose comes out

  /// One frame: x (3 x markers, m, NaN where not seen) at a time in s. The frame's index is its time since
  /// the first one, rounded to the nearest frame, or the next index where that one is taken; skipped frames
  /// count as not seen. Fails without effect when time does not advance, jumps by more
  /// than 2 s or falls more than half a second behind the count of frames, x has the wrong size, or poses
  /// wait to be fetched.
  [[nodiscard]] Status push(double time_s, const Eigen::Matrix3Xd& x);
  /// A force at a point of a body from the next frame on, until the next call; no force lets go. It acts on a
  /// second body, LivePose::pushed_q, that follows the same goals by the same control law, which does not
  /// know the force: stiffness and mass decide how far it goes, and it comes back as (1 + omega t) exp(-omega
  /// t). The tracked body stays as it is. Nothing happens before the first pose. Fails without effect for a
  /// body that is none, a number that is not finite, and more than `kLargestPush_n`.
  /// @param body  index into Model::bodies()  @param point_in_body  m  @param force_in_world  N
  [[nodiscard]] Status push_body(int body, const Eigen::Vector3d& point_in_body,
                                 const Eigen::Vector3d& force_in_world);
  static constexpr double kLargestPush_n = 500.0;  ///< N
  /// End of the stream: poses still delayed become available.
  void finish();
  /// The next pose that is ready, valid until the next call, or nullptr: call it after every frame until
  /// then. Before enough markers were seen, poses are the rest pose with status no_markers. Fails when the
  /// model cannot be controlled in the first pose (a coordinate moves no mass).
  [[nodiscard]] Result<const LivePose*> next();

  /// Names of those held at the rest pose; known once the first pose is out.
  [[nodiscard]] std::vector<std::string> locked_coordinates() const;
  /// Frames by which the poses' times run ahead of the stamp last pushed: 0 or 1 for a stream that keeps its
  /// rate, more where frames come faster than that, or in a burst after a pause.
  [[nodiscard]] std::int64_t frames_ahead() const;
  [[nodiscard]] std::int64_t restarts() const;  ///< times that the body was set anew to its markers

 private:
  struct Impl;
  explicit OnlineTracker(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kinemark::motion
