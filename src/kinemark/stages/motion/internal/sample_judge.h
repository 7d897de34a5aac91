// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Samples judged frame after frame in one direction of time: against the model, the frames before and the
// scales of the recording.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/internal/expected_pose_fit.h"
#include "kinemark/stages/motion/internal/frame_walk.h"
#include "kinemark/stages/motion/internal/step_scale.h"

namespace kinemark::motion::internal {

/// A stretch of samples of one marker that do not fit what came before. Both ends belong to it.
struct Outlier {
  int marker = 0;
  std::int64_t first_frame = 0, last_frame = 0;  ///< first <= last, whatever the direction
  double distance = 0.0;                         ///< largest, in standard deviations
  double length_m = 0.0;                         ///< largest distance from where the marker was expected
  bool returned = true;  ///< the marker came back to where it was expected; false: it never did
  /// From the model's marker, m: where it was, and where it was expected, the farthest.
  double from_model_m = 0.0, expected_from_model_m = 0.0;
  /// What gave it away: its path, a value held digit by digit, a coordinate that is exactly 0.
  enum class Why : std::uint8_t { path, held, zero } why = Why::path;
  /// So much farther from the model's marker than expected that it cannot merely have a new position.
  [[nodiscard]] bool clearly_wrong() const;
  int partner = -1;  ///< the marker in whose position it was while that one was in its own, or -1
};

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
  /// Pose of that frame without what is not believed.
  [[nodiscard]] const Eigen::VectorXd& x() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Judge the frames from `sound`, whose samples are believed, to `last` (included; last < sound: backwards).
/// So is the speed that led to it: the frame before must be sound too, where there is one.
///
/// @param solved  the pose of each frame, all its samples believed, and the positions of its markers
/// @param scale   its growth is learnt when it is first needed
/// @return        in the order in which they end
[[nodiscard]] std::vector<Outlier> judge_samples(const Problem& problem, const IkOptions& options,
                                                 const data::Trajectories& markers,
                                                 const SolvedFrames& solved, StepScale& scale,
                                                 std::int64_t sound, std::int64_t last);

}  // namespace kinemark::motion::internal
