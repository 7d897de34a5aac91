// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The smoother on a live stream: frames go in, smoothed postures come out a fixed lag later.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/smoother/smoother.h"

namespace kinemark::motion {

/// Options of the online smoother.
struct OnlineMotionOptions {
  int lag_frames = 10;     ///< >= 3: what comes out has seen so many frames more
  bool error_bars = true;  ///< q_sd and determined; costs about as much as lag_frames pushes without
  bool limits = true;      ///< clamped coordinates stay in their range (by clipping)

  [[nodiscard]] Status check() const;  ///< Ranges hold.
};

/// One frame that is ready; n coordinates.
struct SmoothedFrame {
  std::int64_t frame = 0;      ///< counted from the first that was pushed
  Eigen::VectorXd q, qd, qdd;  ///< coordinates (rad, m), their rates and accelerations
  Eigen::VectorXd q_sd;        ///< NaN where not determined; white noise only; empty without error bars
  std::vector<std::uint8_t> determined;  ///< empty without error bars
};

/// smooth_motion() on a stream. The strength of the jerk and the noise of the markers come from a recording
/// of the same person (SmootherResult::tuning). Each frame is linearized once, where the frames before expect
/// it, so that a lag as long as the recording gives what smooth_motion() gives up to terms of second order in
/// the error bars. About 1 ms per frame for a whole body, memory for lag_frames frames.
class OnlineMotionSmoother {
 public:
  /// @param markers  names in the model, in the order in which they will come; `tuning` has as many
  static Result<OnlineMotionSmoother> create(const model::Model& model,
                                             const std::vector<std::string>& markers, SmootherTuning tuning,
                                             const OnlineMotionOptions& options = {});
  OnlineMotionSmoother(OnlineMotionSmoother&&) noexcept;             ///< takes a running smoother over
  OnlineMotionSmoother& operator=(OnlineMotionSmoother&&) noexcept;  ///< replaces this one by another
  OnlineMotionSmoother(const OnlineMotionSmoother&) = delete;
  OnlineMotionSmoother& operator=(const OnlineMotionSmoother&) = delete;
  ~OnlineMotionSmoother();

  /// One frame: x (3 x markers, m, NaN where not seen); returns the frame that is lag_frames older, if there
  /// is one. Frames before the first with three markers or more are skipped and not counted. A marker more
  /// than 1000 km away counts as not seen. A frame that cannot be taken in (its normal equations are not
  /// finite) is lost together with the frames that are still inside; counting goes on, and the next frame
  /// starts anew. Fails when x has the wrong size.
  [[nodiscard]] Result<std::optional<SmoothedFrame>> push(const Eigen::Matrix3Xd& x);
  /// No more frames will come: the frames that are still inside, oldest first.
  [[nodiscard]] std::vector<SmoothedFrame> finish();

 private:
  struct Impl;
  explicit OnlineMotionSmoother(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kinemark::motion
