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

/// A force from outside at a point of a body.
struct OutsideForce {
  int body = -1;                                            ///< index into Model::bodies(); -1: there is none
  Eigen::Vector3d point_in_body = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d force_in_world = Eigen::Vector3d::Zero();  ///< N
};

/// The simulated body and its control law. It allocates in its constructor and in the first step only.
class Controller {
 public:
  explicit Controller(const Plan& plan);

  /// Set the body to pose x with the speeds that follow the goals best.
  void start(const Eigen::VectorXd& x, const GoalValues& goal, double time_s);

  /// Acceleration wanted at the present state for goals at this instant, to be held over the step that
  /// follows. False when the simulation has diverged: speeds beyond the plan's limit or not finite.
  ///
  /// @param goal_acceleration  3 x M, of the goals `later_s` after this instant, 0 to half a step
  bool evaluate(const GoalValues& goal, double time_s, const Eigen::Matrix3Xd& goal_acceleration,
                double later_s);
  /// The same with the acceleration that the goals have at this instant.
  bool evaluate(const GoalValues& goal, double time_s) { return evaluate(goal, time_s, goal.a, 0.0); }

  /// How much later than the beginning of a step of length h its acceleration is the goals', so that speed
  /// and position follow goals of constant jerk without an error; 0 without feed-forward.
  [[nodiscard]] double later_s(double h) const;

  /// Put the body into pose x; its speeds stay. To be followed by evaluate().
  void place(const Eigen::VectorXd& x) {
    x_ = x;
    forget_step();
  }

  /// From the next evaluate() on follow all levels in one damped sum of squares, or one after the other.
  void join(bool joined) { joined_ = joined; }

  /// From the next evaluate() on this force acts on the body. The control law does not know it: it cancels
  /// nothing of it.
  void push(const OutsideForce& force) { outside_ = force; }

  /// Keep the present state, for go_back().
  void keep();
  /// Back to the state that was kept.
  void go_back();

  /// Integrate over the time step h with the acceleration just computed: x += h v + h^2 a / 2, v += h a;
  /// within the limits.
  void advance(double h);

  [[nodiscard]] const Eigen::VectorXd& x() const { return x_; }
  [[nodiscard]] const Eigen::VectorXd& v() const { return v_; }
  /// Acceleration at the instant last evaluated: between those of the step that ended and the one that
  /// begins.
  [[nodiscard]] const Eigen::VectorXd& a() const { return now_a_; }
  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] double smallest_singular() const { return smallest_; }
  /// kinematics() and velocities() of the state last evaluated.
  [[nodiscard]] model::Workspace& workspace() { return w_; }
  [[nodiscard]] std::int64_t steps() const { return steps_; }

 private:
  /// Right-hand sides r of J a = r from markers and tasks, and rows of the tasks.
  void find_commands(const GoalValues& goal, double time_s, const Eigen::Matrix3Xd& goal_acceleration,
                     double later_s);
  /// Accelerations of the markers (3 x M) in the present state with accelerations `a` of the speeds.
  void find_marker_accelerations(const Eigen::VectorXd& a, Eigen::Matrix3Xd& out);
  /// Nothing is known of a step that ends here.
  void forget_step() { step_s_ = 0.0; }
  void gather_level(const Plan::Level& level, std::size_t index, const Eigen::VectorXd& weight);
  /// The loop constraints of the model, with priority over all levels.
  void close_loops();
  void solve(const Eigen::VectorXd& weight);
  void solve_joined();
  /// The force from outside as forces of the speeds.
  void project_outside_force();
  /// Hold coordinates that would exceed a limit; true when another coordinate is held.
  bool hold_at_limits();

  const Plan& plan_;
  const model::Model& model_;
  model::Workspace w_;
  PrioritySolver solver_;
  bool one_level_ = false;  // of markers and tasks, without loops: the fast path can be used
  bool have_jacobian_ = false, joined_ = false;
  Eigen::VectorXd x_, v_, a_, now_a_, wished_, bias_, normal_force_, held_a_, move_;
  Eigen::VectorXd weight_;  // M, of markers that are goals themselves
  Eigen::VectorXd kept_x_, kept_v_, kept_a_;
  OutsideForce outside_;
  Eigen::VectorXd outside_force_;  // of the speeds
  int loop_rank_ = 0;              // directions that the loops fix
  Eigen::Matrix3Xd command_;
  Eigen::Matrix3Xd marker_begun_, marker_ended_;  // of the step with a_: at its beginning and its end
  double step_s_ = 0.0;                           // length of the step that ends here; 0: there is none
  double later_s_ = 0.0;                          // what a_ is later than its evaluation
  Eigen::MatrixXd M_, H_, J_, loop_J_, joined_J_;
  Eigen::VectorXd loop_gap_, loop_r_, joined_r_;
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
