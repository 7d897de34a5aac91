// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How far good samples lie from what the frame before leads to expect, learnt from a
// recording: the positions of markers on their bodies, and the speeds of the body.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/stages/motion/internal/frame_walk.h"

namespace kinemark::motion::internal {

/// Scales of a recording, one standard deviation each, from quantiles: a stretch of bad samples hardly
/// matters.
class StepScale {
 public:
  StepScale(const Problem& problem, const SolvedFrames& solved);

  Eigen::VectorXd position;  ///< M, m per axis: step of a marker's position on its body from frame to frame
  Eigen::VectorXd spread;    ///< M, m per axis: of its position over the recording
  Eigen::Matrix3Xd centre;   ///< 3 x M, m: its usual position
  Eigen::VectorXd speed;     ///< nv, rad or m: what a step differs by from the one before
  Eigen::VectorXd rare;      ///< nv, rad or m: what it differs by in one frame of sixteen
  Eigen::VectorXd stride;    ///< nv, rad or m: of a step itself

  /// Learn how steps grow with the number of frames. Takes as long as all the rest, and only recordings in
  /// which a marker was away need it: position_sd_after() does it then. A second call does nothing.
  void learn_growth();
  /// Standard deviation per axis of the step of a position over so many frames, m.
  [[nodiscard]] double position_sd_after(Eigen::Index marker, std::int64_t frames);

 private:
  void find_usual();
  void learn_positions();
  void learn_speeds();

  const Problem& problem_;
  const SolvedFrames& solved_;
  std::vector<std::uint8_t> usual_;  ///< F; 0: the frame costs far more than others
  std::vector<double> growth_;       ///< over 1, 2, 4, ... frames against one; empty: not learnt
};

}  // namespace kinemark::motion::internal
