// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Samples of a live stream judged as they come: the judge of recordings, with scales learnt from the frames
// so far.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "kinemark/stages/motion/internal/sample_judge.h"

namespace kinemark::motion::internal {

/// Judges every sample of a stream once, before it is used. During the first half second nothing is left out:
/// scales are not known yet. They are learnt again after 1, 2 and 4 s, then every 4 s, from the last 4 s.
/// Memory use is constant.
class StreamJudge {
 public:
  /// Both references must outlive the judge.
  StreamJudge(const Problem& problem, const IkOptions& options, double rate_hz);
  StreamJudge(const StreamJudge&) = delete;
  StreamJudge& operator=(const StreamJudge&) = delete;

  /// The next frame: 3 x M samples in m, and weights (0: not seen). A sample that is not believed is replaced
  /// by the position that its marker has on the body; one that merely repeats itself gets the weight 0.
  void judge(Eigen::Matrix3Xd& y, Eigen::VectorXd& weight);
  /// Per marker: 1: its sample of that frame was not believed.
  [[nodiscard]] const std::vector<std::uint8_t>& out() const { return out_; }

 private:
  void keep_frame(const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight, double cost, bool converged);
  void learn();
  /// Samples that repeat one value while the model's marker moves on.
  void drop_held(const Eigen::Matrix3Xd& y, Eigen::VectorXd& weight);

  Problem problem_;  // its number of frames is that of the window
  const IkOptions& options_;
  double rate_hz_;
  std::int64_t capacity_, frames_ = 0, learn_at_;
  FrameSolver solver_;
  SolvedFrames window_, ordered_;  // a ring, and what it holds from the oldest frame on
  std::optional<StepScale> scale_;
  std::optional<FrameJudge> judge_;
  Eigen::VectorXd x_, before_;
  std::vector<float> position_;
  std::vector<std::uint8_t> out_;
  Eigen::Matrix3Xd held_, begun_;      // per marker: value that repeats, and where the model had it at first
  std::vector<std::int64_t> repeats_;  // per marker: frames with that value
};

}  // namespace kinemark::motion::internal
