// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Samples judged frame after frame in one direction of time: against the model, the frames before and the
// scales of the recording.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "kinemark/stages/motion/internal/expected_pose_fit.h"
#include "kinemark/stages/motion/internal/outlier_account.h"
#include "kinemark/stages/motion/internal/step_scale.h"

namespace kinemark::motion::internal {

/// A frame to be judged. What it points to must live until it was.
struct JudgedFrame {
  std::int64_t index = 0;            ///< counts up or down by one from frame to frame
  const Eigen::Matrix3Xd* y = {};    ///< 3 x M samples, m
  const Eigen::VectorXd* seen = {};  ///< M; 0 where not seen
  const double* state = {};          ///< pose that fits best when all samples are believed
  const float* position = {};  ///< 3 x M: of each marker on its body in that pose, m; NaN where not seen
};

/// Judges frame after frame, for recordings and live streams.
class FrameJudge {
 public:
  /// All references must outlive the judge.
  FrameJudge(const Problem& problem, const IkOptions& options, double rate_hz, StepScale& scale);
  FrameJudge(const FrameJudge&) = delete;
  FrameJudge& operator=(const FrameJudge&) = delete;
  ~FrameJudge();

  /// Believe a first frame, and the step that led to it from the state `before` (null: not known).
  void begin(const JudgedFrame& frame, const Eigen::VectorXd* before, std::int64_t direction);
  void judge(const JudgedFrame& frame);
  /// Stretches found, those that still last included, in the order in which they end.
  [[nodiscard]] std::vector<Outlier> finish();
  /// Drop stretches that have ended; for streams, which never finish.
  void forget();

  /// Per marker: 1: its sample in the frame last judged is not believed.
  [[nodiscard]] const std::vector<std::uint8_t>& out() const;
  /// 3 x M: where the markers of that frame should be, m. Valid where one is not believed.
  [[nodiscard]] const Eigen::Matrix3Xd& expected() const;
  /// Poses that were solved for so far.
  [[nodiscard]] std::int64_t solves() const;
  /// Pose of that frame without what is not believed.
  [[nodiscard]] const Eigen::VectorXd& x() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kinemark::motion::internal
