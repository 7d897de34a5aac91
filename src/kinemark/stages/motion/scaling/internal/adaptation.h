// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The estimate of adapt_model(), step by step. Theory: docs/theory/scaling.md
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/scaling/adapt.h"
#include "kinemark/stages/motion/scaling/geometry.h"
#include "kinemark/stages/motion/scaling/internal/joint_terms.h"
#include "kinemark/stages/motion/scaling/internal/projection.h"
#include "kinemark/stages/motion/scaling/internal/scatter.h"
#include "kinemark/stages/motion/scaling/internal/tissue.h"

namespace kinemark::motion::internal {

/// Holds references to all but the problem and the states; they must outlive it.
class Adaptation {
 public:
  /// States: columns are the problem's frames, the postures to start from.
  Adaptation(const data::ModelDescription& model, const data::Trajectories& markers,
             const std::vector<GeometryParameter>& parameters, const AdaptOptions& options, Problem problem,
             Eigen::MatrixXd states, const Progress& progress);

  /// Fills the estimates; the fields of describe() are left to the caller.
  Status run(AdaptResult& result);

  [[nodiscard]] const Eigen::VectorXd& change() const { return x_; }
  /// Covariance without the prior of the marker positions.
  [[nodiscard]] const Eigen::MatrixXd& data_covariance() const { return data_covariance_; }
  [[nodiscard]] const Problem& problem() const { return projection_.problem(); }
  [[nodiscard]] const Eigen::MatrixXd& states() const { return states_; }

 private:
  /// What is known of the parameters besides the motion, in units of the squares.
  struct Known {
    Eigen::MatrixXd S;  ///< information
    Eigen::VectorXd g;  ///< parameters move along it
    double cost = 0.0;
  };
  /// Priors and measured joints at a geometry. @param position_sd  above 0: least prior of marker positions
  [[nodiscard]] Known known(const Eigen::VectorXd& x, double position_sd = 0.0) const;
  [[nodiscard]] double residual_noise() const;
  /// How much of a step may be taken so that every size stays above a fifth of the model's.
  [[nodiscard]] double share_of(const Eigen::VectorXd& step) const;
  Status iterate(int limit, double least_sd, AdaptResult& result);
  Status settle(AdaptResult& result);
  std::optional<double> step_by(const Quiet& quiet);
  Status find_covariance(AdaptResult& result);

  const std::vector<GeometryParameter>& parameters_;
  const AdaptOptions& options_;
  Projection projection_;
  JointTerms joints_;
  Eigen::MatrixXd states_;
  const data::Trajectories& markers_;
  const Progress& progress_;
  Eigen::VectorXd x_;
  Eigen::MatrixXd data_covariance_;
  ProjectedSums sums_{0};
  NormalSums of_motion_{0};  ///< at the shrunk postures
  double noise_m_ = 0.0;
};

}  // namespace kinemark::motion::internal
