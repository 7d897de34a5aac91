// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The set-up of a run from model, recording and options: markers and tasks of each level, gains, locked
// coordinates.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/stages/motion/control/internal/goals.h"
#include "kinemark/stages/motion/control/internal/priority_solver.h"
#include "kinemark/stages/motion/control/track_options.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {

class GoalTask;

struct Plan {
  Problem problem;          ///< the tracked markers only; limits; locked speeds, ours included
  IkOptions start_options;  ///< how the first pose is found
  struct Level {
    std::vector<int> markers;  ///< indices in problem.model
    std::vector<std::shared_ptr<Task>> tasks;
    std::vector<double> task_weights;  ///< of each task, beside those of its rows
    /// What is known of a task besides.
    struct About {
      std::string text;                ///< as a level names it; empty: not by name
      bool is_angle = false;           ///< its rows are in rad
      bool is_held = false;            ///< its goal is a value that stays
      double points = 1.0;             ///< how many markers it counts like, where it is not made of any
      const GoalTask* made = nullptr;  ///< the task itself where its goal is made of markers
    };
    std::vector<About> about;  ///< of each task
    int task_rows = 0;
    [[nodiscard]] int rows() const { return 3 * static_cast<int>(markers.size()) + task_rows; }
    /// Every goal of it is a value that stays.
    [[nodiscard]] bool is_held() const;
    /// Rows of task `t` at a state; `rows` need no size. `gains`: as GoalTask::follow() has them; no columns
    /// where the goal is not made of markers.
    void evaluate(std::size_t t, const Problem& problem, const model::Workspace& w, const GoalValues& goal,
                  double time_s, TaskRows& rows, Eigen::MatrixXd* gains = nullptr) const;
  };
  std::vector<Level> asked;            ///< levels as the options name them
  std::vector<Level> levels;           ///< as they are solved: these, or all of them in one
  std::vector<double> level_weights;   ///< of squared errors in one level; empty: levels are as asked for
  std::vector<double> level_bounds_m;  ///< of strict levels; empty: one level
  bool levels_given_up = false;        ///< strict levels that are followed in one sum of squares all the time
  Eigen::VectorXd marker_weight;       ///< M, within its level
  Eigen::VectorXd in_levels;           ///< M, 1: a goal itself, 0: only goals of tasks are made of it
  struct Held {
    int coordinate;
    double value;
  };
  std::vector<Held> held;  ///< coordinates that a task holds at a value
  double rate_hz = 0.0;
  double kp = 0.0, kd = 0.0;
  double step_s = 0.0;
  int steps_per_frame = 1;
  PriorityDamping damping;
  bool feed_forward = true;
  bool one_sum = false;  ///< one level of markers alone: its errors are one sum of squares
  bool settle = false;   ///< poses of frames are brought to the best fit
  double posture_kp = 0.0, posture_kd = 0.0;
  double max_speed = 0.0, max_error_m = 0.0;
  double ease_s = 0.0;      ///< over which the goal of a marker that reappears is eased in
  Eigen::VectorXd rest;     ///< state; free joints as the model's default until the start is known
  std::vector<int> locked;  ///< coordinates locked here, not by the model

  /// Set locked coordinates to the rest pose.
  void apply_locks(Eigen::VectorXd& x) const;
};

[[nodiscard]] Result<Plan> make_plan(const model::Model& model, const data::Trajectories& markers,
                                     const TrackOptions& options);

/// The filter of the goals according to the options.
[[nodiscard]] GoalFilter make_filter(double rate_hz, const TrackOptions& options);

/// Poses in which the coordinates moved by the goals are determined.
struct IdlePoses {
  std::vector<Eigen::VectorXd> followed;  ///< poses found by following the goals
  /// A task that is not a point may have zero derivatives in all of `followed` (a distance along a straight
  /// arm), so tasks are also evaluated in these poses, drawn within the limits around one of the others.
  std::vector<Eigen::VectorXd> around;
  std::vector<double> times_s{0.0};  ///< at which tasks are evaluated; moved at any of them counts as moved
};

/// Random poses within the limits, up to half a radian from x; locked and fixed coordinates stay.
[[nodiscard]] std::vector<Eigen::VectorXd> poses_around(const Plan& plan, const Eigen::VectorXd& x);

/// Lock the coordinates of joints that move the goals by less than 1 cm per rad (or m) in more than 5 % of
/// the poses.
void lock_idle(Plan& plan, const IdlePoses& idle_poses);

/// Checks that the mass matrix of the free speeds is positive definite in pose x.
[[nodiscard]] Status check_mass(const Plan& plan, const Eigen::VectorXd& x);

}  // namespace kinemark::motion::internal
