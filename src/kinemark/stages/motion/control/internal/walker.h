// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

#include "kinemark/data/derivatives.h"
#include "kinemark/stages/motion/control/internal/controller.h"
#include "kinemark/stages/motion/control/internal/goals.h"
#include "kinemark/stages/motion/control/internal/level_guard.h"
#include "kinemark/stages/motion/control/internal/levels.h"
#include "kinemark/stages/motion/control/internal/plan.h"
#include "kinemark/stages/motion/internal/frame_solver.h"

namespace kinemark::motion::internal {

/// Eases in the goals of markers that reappear.
///
/// A small weight softens a marker only against others: one that alone moves a coordinate acts fully at any
/// weight and would draw the body to its goal at the rate omega. Its goal therefore starts at the model
/// marker's position and velocity and approaches the measured one along a cubic within `ease_s` (> 0).
class ReturningMarkers {
 public:
  ReturningMarkers(int markers, double ease_s);

  /// From now on all goals of weight above 0 are used unchanged.
  void start(const Eigen::VectorXd& weight);
  /// Not followed so far: its weight is above 0 for the first time since it was 0.
  [[nodiscard]] bool is_new(int marker, const Eigen::VectorXd& weight) const;
  /// Ease in the marker from `time_s` on: its distance from the goal at that time (m), and the difference of
  /// velocities (m/s).
  void lead(int marker, double time_s, const Eigen::Vector3d& miss, const Eigen::Vector3d& miss_rate);
  /// The eased goals; discards the transitions of markers whose weight is 0.
  void apply(double time_s, GoalValues& goal);
  /// What easing in adds to the accelerations (3 x M) of the goals at a time; changes nothing else.
  void add_acceleration(double time_s, Eigen::Matrix3Xd& acceleration) const;

 private:
  struct Lead {
    Eigen::Vector3d miss = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();
    double begun_s = 0.0;
    bool followed = false, led = false;
  };
  double ease_s_;
  std::vector<Lead> leads_;
};

/// Advances the body from frame to frame, for files and live streams.
class Walker {
 public:
  /// The plan must outlive the walker and stay as it is.
  Walker(const Plan& plan, GoalFilter filter, std::int64_t capacity, double t0_s);
  /// Use the derivatives of a recording in place of the filter; `d` must outlive the walker.
  void use_derivatives(const data::Derivatives& d, std::int64_t markers_in_d);

  [[nodiscard]] SampleWindow& samples() { return samples_; }
  [[nodiscard]] const SampleWindow& samples() const { return samples_; }

  /// Set the body to pose x at frame `first`. Needs the cell that begins there.
  void begin(const Eigen::VectorXd& x, std::int64_t first);
  /// Go on to the next frame. Needs the cell that ends there.
  void next();

  /// From the next step on this force acts on a second body that follows the same goals by the same law, made
  /// from the first where there is none. A force of none (body -1) lets it come back; it is gone once it is
  /// where the first one is. The first body knows nothing of it.
  void push(const OutsideForce& force);
  /// That second body; nullptr while nobody has pushed it or it has come back.
  [[nodiscard]] Controller* pushed() { return pushed_ ? &*pushed_ : nullptr; }
  /// Largest distance between the same model markers of both bodies, m; 0 without the second.
  [[nodiscard]] double pushed_m();

  [[nodiscard]] std::int64_t frame() const { return frame_; }
  [[nodiscard]] double time_s() const { return t0_s_ + static_cast<double>(frame_) / plan_.rate_hz; }
  [[nodiscard]] Controller& controller() { return controller_; }
  /// The measured goals; those of markers that reappear are eased in.
  [[nodiscard]] const GoalValues& goal() const { return goal_; }
  [[nodiscard]] bool any_goal() const { return goal_.weight.maxCoeff() > 0.0; }
  /// The simulation diverged before this frame, or the body is farther from its goals than the plan allows.
  /// Or it had lost its goals, which another pose fitted much better, and was set anew.
  [[nodiscard]] bool flagged() const { return flagged_; }
  [[nodiscard]] std::int64_t restarts() const { return restarts_; }
  /// RMS distance of each level as asked for to its goals, m; NaN where it has none.
  [[nodiscard]] const Eigen::VectorXd& level_errors() const { return level_errors_.found(); }
  /// The frame's strict levels were followed in one sum of squares.
  [[nodiscard]] bool relaxed() const { return relaxed_; }
  [[nodiscard]] const LevelGuard& guard() const { return guard_; }
  /// Some strict level is beyond its bound.
  [[nodiscard]] bool beyond() const;
  /// Poses that a solver of inverse kinematics was asked for so far: to settle, or to set the body anew.
  [[nodiscard]] std::int64_t solves() const { return solver_.solves() + settler_.solves(); }

 private:
  void build_cell(std::int64_t first);
  void restart();
  /// Go on from pose x, with the speeds that follow the goals best. False when the simulation diverges there.
  bool set_anew(const Eigen::VectorXd& x);
  /// On to the end of the frame in so many steps. False when the simulation diverged.
  bool cross(int steps);
  /// The same from the frame's beginning in finer steps.
  bool cross_again();
  /// Step s of a frame that is cut into `steps`, from 1. False when the simulation diverged.
  bool step(int s, int steps);
  /// Bring the pose of a frame to the best fit of its goals. False when the body had lost them and was set
  /// anew.
  bool settle();
  /// A body that is not settled may have lost its goals: it is set anew where another pose fits them much
  /// better.
  void recover(double cost);
  /// Look for a better fit than `settled_`, which costs `cost`, from other poses. False: there is none.
  bool try_other_starts(double& cost);
  /// Look for a better fit than `settled_`, which costs `cost`, on the other side of limits. What the best
  /// costs.
  double try_limits(double cost);
  /// Position and velocity errors of model markers whose goals become active now.
  void lead_new_markers(double time_s, double u);
  void judge();
  void watch_levels();
  /// The same step for the body that is pushed.
  void step_pushed(double h, double now, double later);
  /// It is gone when it has come back.
  void end_push();

  const Plan& plan_;
  GoalFilter filter_;
  SampleWindow samples_;
  Controller controller_;
  FrameSolver solver_;
  Problem unbiased_;  // without the pull to the rest pose that first poses need
  FrameSolver settler_;
  GoalCell cell_;
  GoalValues goal_, before_, led_;
  Eigen::Matrix3Xd later_a_;  // of the goals, in the step to come
  ReturningMarkers returning_, kept_returning_;
  const data::Derivatives* derivatives_ = nullptr;
  std::int64_t markers_in_derivatives_ = 0;
  Eigen::VectorXd last_good_, settled_, other_, move_;
  std::vector<std::int64_t> at_limit_;  // per speed: frame in which it last was at a limit; -1: never
  double t0_s_ = 0.0;
  double usual_cost_ = -1.0;  // m^2, of frames whose goals are not eased in; below 0: none yet
  std::int64_t frame_ = 0, restarts_ = 0;
  std::optional<Controller> pushed_;
  double released_s_ = 0.0;           // when the force ended; infinity: it acts
  std::int64_t frames_together_ = 0;  // in a row in which both bodies were at the same place
  LevelErrors level_errors_, pursued_errors_;
  LevelGuard guard_;
  bool flagged_ = false, lost_ = false, relaxed_ = false;
};

}  // namespace kinemark::motion::internal
