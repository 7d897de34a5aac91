// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {

/// Longest change of a state in one iteration, rad or m: beyond it the linearization is not valid.
inline constexpr double kLongestStep = 0.6;

/// Least squares over one frame. Allocates in its constructor only.
class FrameSolver {
 public:
  FrameSolver(const Problem& problem, const IkOptions& options);

  struct Outcome {
    bool converged = false;
    int iterations = 0;
    double cost = 0.0;  ///< of the frame with the chosen loss, as IkOptions defines it
  };

  /// Improve x for measured positions y with weights (0: not seen). `frame` selects the task values.
  Outcome solve(const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight, std::int64_t frame,
                Eigen::VectorXd& x);

  /// Cost of x as it is, square loss.
  double square_cost(const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight, std::int64_t frame,
                     const Eigen::VectorXd& x);

  /// measured - model of the last pose visited, 3 x M; columns of unseen markers are 0.
  [[nodiscard]] const Eigen::Matrix3Xd& residual() const { return residual_; }
  [[nodiscard]] model::Workspace& workspace() { return w_; }
  /// Largest point-constraint gap of the last pose visited, m.
  [[nodiscard]] double loop_gap() const { return gap_.size() == 0 ? 0.0 : gap_.cwiseAbs().maxCoeff(); }
  [[nodiscard]] std::int64_t iterations() const { return iterations_; }
  /// Calls of solve().
  [[nodiscard]] std::int64_t solves() const { return solves_; }

 private:
  /// Kinematics, residuals, loss weights and merit at x.
  double visit(const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight, std::int64_t frame,
               const Eigen::VectorXd& x);
  void add_coordinate_tasks(std::int64_t frame);
  /// Coordinate of a task at the pose last visited.
  [[nodiscard]] double task_value(const Problem::CoordinateTarget& task) const;
  void fix_speeds(const Eigen::VectorXd& x);
  /// Step from the current gradient and matrix; false when the matrix is not positive definite.
  bool step(double damping, bool exact);
  void clip_to_limits(const Eigen::VectorXd& x);
  [[nodiscard]] double merit() const;

  const Problem& problem_;
  const IkOptions& options_;
  const model::Model& model_;
  model::Workspace w_;
  Eigen::Matrix3Xd residual_;
  Eigen::VectorXd effective_weight_, g_, dx_, diagonal_, gap_, multiplier_, q_;
  Eigen::VectorXd scale_;  ///< per speed: 1 for translations, a lever in m for rotations, squared
  Eigen::MatrixXd gauss_newton_, H_, C_, HinvC_, loop_, E_;
  Eigen::LLT<Eigen::MatrixXd> llt_, loop_llt_;
  std::vector<std::uint8_t> held_;
  Eigen::VectorXd x_try_;
  double total_weight_ = 0.0, cost_ = 0.0, loop_penalty_ = 0.0;
  std::int64_t iterations_ = 0, solves_ = 0;
  bool tasks_on_free_joints_ = false;
};

}  // namespace kinemark::motion::internal
