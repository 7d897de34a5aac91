// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/control/internal/goals.h"
#include "kinemark/stages/motion/control/internal/plan.h"
#include "kinemark/stages/motion/control/internal/priority_solver.h"

namespace kinemark::motion::internal {

/// The simulated body and its control law. It allocates in its constructor and in the first step only.
class Controller {
 public:
  explicit Controller(const Plan& plan);

  /// Set the body to pose x with the speeds that follow the goals best.
  void start(const Eigen::VectorXd& x, const GoalValues& goal, double time_s);

  /// Acceleration wanted at the present state for goals at this instant. False when the simulation has
  /// diverged: speeds beyond the plan's limit or not finite.
  bool evaluate(const GoalValues& goal, double time_s);

  /// Put the body into pose x; its speeds stay. To be followed by evaluate().
  void place(const Eigen::VectorXd& x) { x_ = x; }

  /// Keep the present state, for go_back().
  void keep();
  /// Back to the state that was kept.
  void go_back();

  /// Integrate over the time step h with the acceleration just computed: x += h v + h^2 a / 2, v += h a;
  /// within the limits.
  void advance(double h);

  [[nodiscard]] const Eigen::VectorXd& x() const { return x_; }
  [[nodiscard]] const Eigen::VectorXd& v() const { return v_; }
  [[nodiscard]] const Eigen::VectorXd& a() const { return a_; }
  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] double smallest_singular() const { return smallest_; }
  /// kinematics() and velocities() of the state last evaluated.
  [[nodiscard]] model::Workspace& workspace() { return w_; }
  [[nodiscard]] std::int64_t steps() const { return steps_; }

 private:
  /// Right-hand sides r of J a = r from markers and tasks, and rows of the tasks.
  void find_commands(const GoalValues& goal, double time_s);
  void gather_level(const Plan::Level& level, std::size_t index, const Eigen::VectorXd& weight);
  /// The loop constraints of the model, with priority over all levels.
  void close_loops();
  void solve(const Eigen::VectorXd& weight);
  /// Hold coordinates that would exceed a limit; true when another coordinate is held.
  bool hold_at_limits();

  const Plan& plan_;
  const model::Model& model_;
  model::Workspace w_;
  PrioritySolver solver_;
  bool one_level_ = false;  // of markers and tasks, without loops: the fast path can be used
  bool have_jacobian_ = false;
  Eigen::VectorXd x_, v_, a_, wished_, bias_, normal_force_, held_a_, move_;
  Eigen::VectorXd kept_x_, kept_v_, kept_a_;
  Eigen::Matrix3Xd command_;
  Eigen::MatrixXd M_, H_, J_, loop_J_;
  Eigen::VectorXd loop_gap_, loop_r_;
  struct Gathered {
    Eigen::MatrixXd J;
    Eigen::VectorXd r;
    std::vector<TaskRows> tasks;
  };
  std::vector<Gathered> gathered_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
  std::vector<std::uint8_t> held_;
  int rank_ = 0;
  double smallest_ = 0.0;
  std::int64_t steps_ = 0;
};

}  // namespace kinemark::motion::internal
