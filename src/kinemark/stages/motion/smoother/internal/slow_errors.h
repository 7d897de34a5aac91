// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Effect of soft tissue on smoothed coordinates. Errors that change more slowly than the smoother's time
// constant are not averaged out: over a stretch of frames with mean normal matrix H = mean J'WJ and mean
// spread
// B = mean J'W S W J (S the slow part of the marker covariance) the coordinates err by H^-1 B H^-1.
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
  /// At the solved states. Fixed speeds have no error.
  SlowErrors(const model::Model& model, const Observations& observations, const NoiseSplit& noise,
             const std::vector<std::uint8_t>& fixed, const data::JointMotion& motion,
             const Eigen::MatrixXd& states);

  /// Variance of coordinate c in frame f.
  [[nodiscard]] double variance(std::int64_t f, int c) const;

 private:
  std::int64_t block_ = 1;
  Eigen::MatrixXd variance_;  ///< n x blocks
};

}  // namespace kinemark::motion::internal
