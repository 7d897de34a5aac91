// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Gauss-Newton over all frames of a recording: observations of every frame, white third differences between
// them, limits as an active set.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/smoother/internal/frame_rows.h"
#include "kinemark/stages/motion/smoother/internal/step_prior.h"

namespace kinemark::motion::internal {

/// What may move and how far, per speed.
struct SpeedBounds {
  std::vector<std::uint8_t> fixed;
  Eigen::VectorXd lower, upper;  ///< +-infinity where unlimited
};

class WholeTrajectory {
 public:
  /// @param step_precision  inverse of the covariance of a third difference, speeds x speeds.
  WholeTrajectory(const model::Model& model, const Observations& observations, std::int64_t frames,
                  const Eigen::MatrixXd& step_precision, SpeedBounds bounds);

  struct Outcome {
    bool converged = false, stopped = false;
    int iterations = 0;
    double cost = 0.0;
    /// Of each frame: its posture would move by more than 0.015 standard deviations in another step. All 0
    /// when converged.
    std::vector<std::uint8_t> unsettled;
  };
  /// Improve all postures (one column per frame, 4 or more) by at most so many steps.
  Outcome solve(Eigen::MatrixXd& states, int max_iterations, const Progress& progress);

  /// Covariances at the given postures without limits, from the last frame to the first. The visitor gets the
  /// first of three neighbouring frames and their joint covariance (3 nv x 3 nv).
  using Visitor = std::function<void(std::int64_t first, const Eigen::MatrixXd& covariance)>;
  void covariances(const Eigen::MatrixXd& states, const Visitor& visitor);

 private:
  double cost(const Eigen::MatrixXd& states);
  double evaluate(const Eigen::MatrixXd& states);
  template <class Visit>
  void each_limited(const Eigen::MatrixXd& states, const Visit& visit);
  void find_step(const Eigen::MatrixXd& states);
  void add_springs(const Eigen::MatrixXd& states, std::int64_t k);
  void load(const Eigen::MatrixXd& states, std::int64_t k, bool with_right);
  /// Eliminate [first, last); factors are kept for it when asked.
  void forward(const Eigen::MatrixXd& states, std::int64_t first, std::int64_t last, bool keep,
               bool with_right);
  void sweep(const Eigen::MatrixXd& states, bool with_right,
             const std::function<void(std::int64_t k, const NodeFactor& factor)>& back);

  const model::Model& model_;
  const Observations& observations_;
  std::int64_t frames_, segment_;
  SpeedBounds bounds_;
  FrameRows rows_;
  StepPrior prior_;
  Window window_;
  double floor_;
  std::vector<NodeFactor> factors_;
  NodeFactor scratch_;
  std::vector<std::int8_t> side_;  ///< nv per frame: 1 at its upper limit, -1 at its lower, 0 between
  Eigen::MatrixXd gradient_, step_, H_;
  Eigen::VectorXd g_;
};

}  // namespace kinemark::motion::internal
