// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/walker.h"

#include <cmath>
#include <utility>

#include "kinemark/model/kinematics.h"

namespace kinemark::motion::internal {

Walker::Walker(const Plan& plan, GoalFilter filter, std::int64_t capacity, double t0_s)
    : plan_(plan),
      filter_(std::move(filter)),
      samples_(plan.problem.model.marker_count(), capacity),
      controller_(plan),
      solver_(plan.problem, plan.start_options),
      cell_(plan.problem.model.marker_count()),
      goal_(plan.problem.model.marker_count()),
      before_(goal_),
      led_(goal_),
      returning_(plan.problem.model.marker_count(), plan.ease_s),
      last_good_(plan.rest),
      t0_s_(t0_s) {}

void Walker::use_derivatives(const data::Derivatives& d, std::int64_t markers_in_d) {
  derivatives_ = &d;
  markers_in_derivatives_ = markers_in_d;
}

void Walker::build_cell(std::int64_t first) {
  if (derivatives_ != nullptr)
    filter_.build(samples_, first, *derivatives_, plan_.problem.data_marker, markers_in_derivatives_,
                  plan_.problem.first_frame, cell_);
  else
    filter_.build(samples_, first, cell_);
}

void Walker::begin(const Eigen::VectorXd& x, std::int64_t first) {
  frame_ = first;
  build_cell(first);
  cell_.at(0.0, goal_);
  controller_.start(x, goal_, time_s());
  returning_.start(goal_.weight);
  flagged_ = !controller_.evaluate(goal_, time_s());
  if (flagged_) restart();
  judge();
  last_good_ = x;
}

void Walker::next() {
  flagged_ = false;
  build_cell(frame_);
  for (int s = 1; s <= plan_.steps_per_frame && !flagged_; ++s) flagged_ = !step(s);
  ++frame_;
  if (flagged_) {
    cell_.at(1.0, goal_);
    restart();
  }
  judge();
  if (!flagged_) last_good_ = controller_.x();
}

bool Walker::step(int s) {
  const double begun = time_s() + (s - 1) * plan_.step_s, now = time_s() + s * plan_.step_s;
  cell_.at(static_cast<double>(s) / plan_.steps_per_frame, goal_);
  lead_new_markers(begun, static_cast<double>(s - 1) / plan_.steps_per_frame);
  controller_.advance(plan_.step_s);
  led_ = goal_;
  returning_.apply(now, led_);
  return controller_.evaluate(led_, now);
}

void Walker::lead_new_markers(double time_s, double u) {
  bool looked = false;
  auto& w = controller_.workspace();
  for (int m = 0; m < static_cast<int>(goal_.weight.size()); ++m) {
    if (!returning_.is_new(m, goal_.weight)) continue;
    if (!looked) cell_.at(u, before_);
    looked = true;
    const Eigen::Vector3d position = w.marker.col(m);
    const int body = plan_.problem.model.markers()[static_cast<std::size_t>(m)].body;
    returning_.lead(m, time_s, position - before_.x.col(m),
                    model::point_velocity(w, body, position) - before_.v.col(m));
  }
}

void Walker::restart() {
  ++restarts_;
  returning_.start(goal_.weight);
  Eigen::VectorXd x = last_good_;
  if (any_goal()) solver_.solve(goal_.x, goal_.weight, 0, x);
  if (!x.allFinite()) x = last_good_;
  controller_.start(x, goal_, time_s());
  if (controller_.evaluate(goal_, time_s())) return;
  // Goals that move faster than any body can: hold the pose until they are plausible again.
  GoalValues nothing(static_cast<int>(goal_.weight.size()));
  controller_.start(last_good_, nothing, time_s());
  controller_.evaluate(nothing, time_s());
}

void Walker::judge() {
  double squares = 0.0, weight = 0.0;
  const auto& position = controller_.workspace().marker;
  for (Eigen::Index m = 0; m < goal_.weight.size(); ++m) {
    if (goal_.weight[m] == 0.0) continue;
    squares += goal_.weight[m] * (goal_.x.col(m) - position.col(m)).squaredNorm();
    weight += goal_.weight[m];
  }
  if (weight > 0.0 && !(std::sqrt(squares / weight) <= plan_.max_error_m)) flagged_ = true;
}

}  // namespace kinemark::motion::internal
