// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/smoother/observations.h"

namespace kinemark::motion::internal {

/// Observations of one frame turned into normal equations of its posture; closed loops count as observations
/// to 10 um. One thread's scratch.
class FrameRows {
 public:
  explicit FrameRows(const model::Model& model);

  /// Cost of posture x; keeps what the two functions below need.
  double visit(const Observations& observations, std::int64_t f, const Eigen::VectorXd& x);
  /// Minus the gradient of the cost by the motion of the posture.
  void descent(Eigen::VectorXd& g);
  /// Gauss-Newton matrix, full.
  void matrix(Eigen::MatrixXd& H);
  [[nodiscard]] model::Workspace& workspace() { return w_; }
  [[nodiscard]] const MarkerInformation& information() const { return seen_; }

 private:
  const model::Model& model_;
  model::Workspace w_;
  MarkerInformation seen_;
  Eigen::VectorXd gap_;
  Eigen::MatrixXd C_;
};

}  // namespace kinemark::motion::internal
