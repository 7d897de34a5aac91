// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Effect of soft tissue on smoothed coordinates. Skin that slides with the posture changes as slowly as the
// posture does: no smoothing averages it out, and beside a gap it goes on through the gap. The smoother is
// linear in the markers near its solution, so its answer to a marker that lies elsewhere throughout, and to
// a segment whose markers all do, is another solution of the same normal equations with J'W u on the right;
// the answers, times the slow standard deviations, squared and summed, are the variance.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/smoother/internal/noise.h"
#include "kinemark/stages/motion/smoother/observations.h"

namespace kinemark::motion::internal {

class SlowErrors {
 public:
  /// At the solved states. Fixed speeds have no error. Frames are taken together in nodes of 0.05 s.
  /// @param step_precision  of the smoother, inverse of the covariance of a third difference between frames
  SlowErrors(const model::Model& model, const Observations& observations, const NoiseSplit& noise,
             const std::vector<std::uint8_t>& fixed, const data::JointMotion& motion,
             const Eigen::MatrixXd& states, const Eigen::MatrixXd& step_precision, int threads);

  /// Variance of coordinate c in frame f.
  [[nodiscard]] double variance(std::int64_t f, int c) const;

 private:
  std::int64_t frames_per_node_ = 1;
  Eigen::MatrixXd variance_;  ///< n x nodes
};

}  // namespace kinemark::motion::internal
