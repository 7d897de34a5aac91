// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/walker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/start.h"

namespace kinemark::motion::internal {
namespace {

// As for the frames of inverse kinematics: what a frame may cost beyond the usual before other poses are
// tried, how many, and how much cheaper one must be to take the place.
constexpr double kCostly = 9.0;
constexpr double kCostly_m2 = 1e-4;
constexpr int kOtherStarts = 6;
constexpr double kCheaper = 0.98;
constexpr double kMuchCheaper = 0.5;  // than a pose that is no best fit
constexpr double kMemory = 0.95;      // of the usual cost, per frame
constexpr double kLostPose = 0.3;   // rad or m: a body so far from the best fit may have come to a wrong one
constexpr double kSameCost = 1e-6;  // of the cost
constexpr double kAtLimit = 1e-9;   // rad or m
constexpr double kOffLimit = 0.1;   // rad or m: near a limit
constexpr int kFiner[] = {4, 16, 64};  // steps for one, in frames in which the simulation diverges
constexpr double kRemembered_s = 0.5;  // that a coordinate was at its limit
constexpr double kTogether_m = 1e-4;   // a body that was pushed is back
constexpr double kTogether_s = 0.02;   // if it stays so long
constexpr double kNoReturn_s = 3.0;    // a body that hangs in another pose is taken back

Problem without_tasks(Problem problem) {
  problem.coordinate_tasks.clear();
  return problem;
}

}  // namespace

ReturningMarkers::ReturningMarkers(int markers, double ease_s) : ease_s_(ease_s), leads_(at(markers)) {}

void ReturningMarkers::start(const Eigen::VectorXd& weight) {
  for (Eigen::Index m = 0; m < weight.size(); ++m) {
    leads_[at(m)].followed = weight[m] > 0.0;
    leads_[at(m)].led = false;
  }
}

bool ReturningMarkers::is_new(int marker, const Eigen::VectorXd& weight) const {
  return weight[marker] > 0.0 && !leads_[at(marker)].followed;
}

void ReturningMarkers::lead(int marker, double time_s, const Eigen::Vector3d& miss,
                            const Eigen::Vector3d& miss_rate) {
  leads_[at(marker)] = {.miss = miss, .rate = miss_rate, .begun_s = time_s, .followed = true, .led = true};
}

void ReturningMarkers::apply(double time_s, GoalValues& goal) {
  for (Eigen::Index m = 0; m < goal.weight.size(); ++m) {
    auto& lead = leads_[at(m)];
    if (goal.weight[m] == 0.0) lead.followed = lead.led = false;
    const double u = (time_s - lead.begun_s) / ease_s_;
    if (!lead.led || u >= 1.0) {
      lead.led = false;
      continue;
    }
    // Hermite: miss and its rate at u = 0, nothing at u = 1.
    const Eigen::Vector3d rate = ease_s_ * lead.rate;
    goal.x.col(m) += (1.0 + u * u * (2.0 * u - 3.0)) * lead.miss + u * (1.0 - u) * (1.0 - u) * rate;
    goal.v.col(m) += (6.0 * u * (u - 1.0) * lead.miss + (1.0 + u * (3.0 * u - 4.0)) * rate) / ease_s_;
    goal.a.col(m) += ((12.0 * u - 6.0) * lead.miss + (6.0 * u - 4.0) * rate) / (ease_s_ * ease_s_);
  }
}

void ReturningMarkers::add_acceleration(double time_s, Eigen::Matrix3Xd& acceleration) const {
  for (Eigen::Index m = 0; m < acceleration.cols(); ++m) {
    const auto& lead = leads_[at(m)];
    const double u = (time_s - lead.begun_s) / ease_s_;
    if (lead.led && u < 1.0)
      acceleration.col(m) +=
          ((12.0 * u - 6.0) * lead.miss + (6.0 * u - 4.0) * ease_s_ * lead.rate) / (ease_s_ * ease_s_);
  }
}

Walker::Walker(const Plan& plan, GoalFilter filter, std::int64_t capacity, double t0_s)
    : plan_(plan),
      filter_(std::move(filter)),
      samples_(plan.problem.model.marker_count(), capacity),
      controller_(plan),
      solver_(plan.problem, plan.start_options),
      unbiased_(without_tasks(plan.problem)),
      settler_(unbiased_, plan.start_options),
      cell_(plan.problem.model.marker_count()),
      goal_(plan.problem.model.marker_count()),
      before_(goal_),
      led_(goal_),
      later_a_(goal_.a),
      returning_(plan.problem.model.marker_count(), plan.ease_s),
      kept_returning_(returning_),
      last_good_(plan.rest),
      settled_(plan.rest),
      other_(plan.rest),
      move_(Eigen::VectorXd::Zero(plan.problem.model.speed_count())),
      at_limit_(at(plan.problem.model.speed_count()), -1),
      t0_s_(t0_s),
      level_errors_(plan),
      pursued_errors_(plan),
      guard_(plan.level_bounds_m, plan.rate_hz, plan.levels_given_up) {
  controller_.join(guard_.joined());
}

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
  usual_cost_ = -1.0;
  settled_ = x;
  guard_ = LevelGuard(plan_.level_bounds_m, plan_.rate_hz, plan_.levels_given_up);
  controller_.join(guard_.joined());
  if (plan_.settle && any_goal()) settler_.solve(goal_.x, goal_.weight, 0, settled_);
  controller_.start(settled_, goal_, time_s());
  returning_.start(goal_.weight);
  flagged_ = !controller_.evaluate(goal_, time_s());
  if (flagged_) restart();
  judge();
  led_ = goal_;
  watch_levels();
  last_good_ = settled_;
}

void Walker::next() {
  flagged_ = lost_ = false;
  build_cell(frame_);
  controller_.keep();
  if (pushed_) pushed_->keep();
  kept_returning_ = returning_;
  flagged_ = !cross(plan_.steps_per_frame) && !cross_again();
  ++frame_;
  if (flagged_) {
    cell_.at(1.0, goal_);
    restart();
  }
  flagged_ = flagged_ || lost_;
  judge();
  watch_levels();
  end_push();
  if (!flagged_) last_good_ = controller_.x();
}

bool Walker::cross(int steps) {
  for (int s = 1; s <= steps; ++s)
    if (!step(s, steps)) return false;
  return true;
}

// Where a limb passes a singular pose, a direction that hardly moves the goals may for a moment turn faster
// than the steps can follow.
bool Walker::cross_again() {
  for (const int finer : kFiner) {
    controller_.go_back();
    if (pushed_) pushed_->go_back();
    returning_ = kept_returning_;
    lost_ = false;
    if (cross(finer * plan_.steps_per_frame)) return true;
  }
  return false;
}

bool Walker::step(int s, int steps) {
  const double h = steps == plan_.steps_per_frame ? plan_.step_s : 1.0 / (plan_.rate_hz * steps);
  const double begun = time_s() + (s - 1) * h, now = time_s() + s * h;
  cell_.at(static_cast<double>(s) / steps, goal_);
  lead_new_markers(begun, static_cast<double>(s - 1) / steps);
  controller_.advance(h);
  led_ = goal_;
  returning_.apply(now, led_);
  if (s == steps && plan_.settle && !settle()) {
    lost_ = true;
    pushed_.reset();
    return controller_.evaluate(goal_, now);
  }
  const double later = controller_.later_s(h);
  cell_.acceleration_at((s + later / h) / steps, later_a_);
  returning_.add_acceleration(now + later, later_a_);
  step_pushed(h, now, later);
  return controller_.evaluate(led_, now, later_a_, later);
}

void Walker::push(const OutsideForce& force) {
  const bool acts = force.body >= 0;
  if (acts && !pushed_) pushed_.emplace(controller_);
  if (!pushed_ || (!acts && !std::isinf(released_s_))) return;
  pushed_->push(force);
  released_s_ = acts ? std::numeric_limits<double>::infinity() : time_s();
  frames_together_ = 0;
}

double Walker::pushed_m() {
  if (!pushed_) return 0.0;
  return (pushed_->workspace().marker - controller_.workspace().marker).colwise().norm().maxCoeff();
}

void Walker::step_pushed(double h, double now, double later) {
  if (!pushed_) return;
  pushed_->advance(h);
  if (!pushed_->evaluate(led_, now, later_a_, later)) pushed_.reset();
}

void Walker::end_push() {
  if (!pushed_ || std::isinf(released_s_)) return;
  frames_together_ = pushed_m() < kTogether_m ? frames_together_ + 1 : 0;
  if (static_cast<double>(frames_together_) >= kTogether_s * plan_.rate_hz ||
      time_s() - released_s_ > kNoReturn_s)
    pushed_.reset();
}

bool Walker::settle() {
  if (!(led_.weight.maxCoeff() > 0.0) || !controller_.x().allFinite()) return true;
  settled_ = controller_.x();
  auto outcome = settler_.solve(led_.x, led_.weight, 0, settled_);
  model::difference(plan_.problem.model, controller_.x(), settled_, move_);
  if (!(move_.cwiseAbs().maxCoeff() < kLostPose)) {
    // The step led away: the best fit near the frame before counts, unless it is worse.
    other_ = last_good_;
    const auto near = settler_.solve(led_.x, led_.weight, 0, other_);
    if (!(outcome.cost < (1.0 - kSameCost) * near.cost)) {
      settled_ = other_;
      outcome = near;
    }
  }
  outcome.cost = try_limits(outcome.cost);
  bool kept = true;
  // Goals that are still eased in come from where the body was and fit no pose.
  const bool eased = led_.x != goal_.x;
  if (!eased && usual_cost_ >= 0.0 && outcome.cost > kCostly * usual_cost_ + kCostly_m2) {
    kept = !try_other_starts(outcome.cost);
  }
  if (!eased)
    usual_cost_ = usual_cost_ < 0.0 ? outcome.cost : kMemory * usual_cost_ + (1.0 - kMemory) * outcome.cost;
  if (kept) {
    controller_.place(settled_);
  } else {
    ++restarts_;
    returning_.start(goal_.weight);
    controller_.start(settled_, goal_, time_s() + plan_.steps_per_frame * plan_.step_s);
  }
  return kept;
}

bool Walker::try_other_starts(double& cost) {
  other_ = settled_;
  const auto outcome =
      find_start(unbiased_, plan_.start_options, settler_, goal_.x, goal_.weight, 0, kOtherStarts, other_);
  if (!(outcome.cost < kCheaper * cost)) return false;
  settled_ = other_;
  cost = outcome.cost;
  return true;
}

// A stretched arm: with the elbow at its limit the arm turns freely about itself, and may have turned to
// where bending the elbow does not help any more, while it would help in another direction; and the other way
// round. So a coordinate at its limit is bent a little, one that was there and is still near it is stretched,
// and it is held there until all others have found their best, and then let go.
double Walker::try_limits(double cost) {
  const auto& p = plan_.problem;
  for (const auto& c : p.model.coordinates()) {
    const int k = c.speed_idx;
    if (k < 0 || p.fixed_speed[at(k)] != 0) continue;
    const double low = p.lower[k], high = p.upper[k], off_limit = std::min(kOffLimit, 0.25 * (high - low));
    const double q = settled_[c.state_idx];
    const bool at_limit = q <= low + kAtLimit || q >= high - kAtLimit;
    if (at_limit) at_limit_[at(k)] = frame_;
    if (at_limit_[at(k)] < 0 ||
        static_cast<double>(frame_ - at_limit_[at(k)]) > kRemembered_s * plan_.rate_hz)
      continue;
    const bool is_low = q < low + off_limit;
    if (!is_low && q <= high - off_limit) continue;
    other_ = settled_;
    other_[c.state_idx] = is_low ? (at_limit ? low + off_limit : low) : (at_limit ? high - off_limit : high);
    unbiased_.fixed_speed[at(k)] = 1;
    settler_.solve(led_.x, led_.weight, 0, other_);
    unbiased_.fixed_speed[at(k)] = 0;
    const auto outcome = settler_.solve(led_.x, led_.weight, 0, other_);
    if (!(outcome.cost < (1.0 - kSameCost) * cost)) continue;
    settled_ = other_;
    cost = outcome.cost;
  }
  return cost;
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

bool Walker::set_anew(const Eigen::VectorXd& x) {
  ++restarts_;
  returning_.start(goal_.weight);
  controller_.start(x, goal_, time_s());
  return controller_.evaluate(goal_, time_s());
}

void Walker::restart() {
  Eigen::VectorXd x = last_good_;
  if (any_goal()) solver_.solve(goal_.x, goal_.weight, 0, x);
  if (!x.allFinite()) x = last_good_;
  if (set_anew(x)) return;
  // Goals that move faster than any body can: hold the pose until they are plausible again.
  GoalValues nothing(static_cast<int>(goal_.weight.size()));
  controller_.start(last_good_, nothing, time_s());
  controller_.evaluate(nothing, time_s());
}

// Goals that are still eased in come from where the body was and fit no pose.
void Walker::recover(double cost) {
  if (led_.x != goal_.x) return;
  const double most = kCostly * usual_cost_ + kCostly_m2;
  if (usual_cost_ >= 0.0 && cost > most) {
    settled_ = controller_.x();
    double best = settler_.solve(goal_.x, goal_.weight, 0, settled_).cost;
    try_other_starts(best);
    if (best < kMuchCheaper * cost) {
      set_anew(settled_);
      flagged_ = true;
      return;
    }
  }
  usual_cost_ = usual_cost_ < 0.0 ? cost : kMemory * usual_cost_ + (1.0 - kMemory) * std::min(cost, most);
}

bool Walker::beyond() const {
  for (std::size_t i = 0; i < plan_.level_bounds_m.size(); ++i)
    if (guard_.is_beyond(i, level_errors()[static_cast<Eigen::Index>(i)])) return true;
  return false;
}

// A marker that comes back is far from its goal at once, and led there: that is no fault of the levels.
void Walker::watch_levels() {
  if (plan_.asked.size() < 2) return;
  level_errors_.find(controller_.workspace(), goal_, time_s());
  relaxed_ = guard_.joined();
  if (plan_.level_bounds_m.empty()) return;
  guard_.look(pursued_errors_.find(controller_.workspace(), flagged_ ? goal_ : led_, time_s()));
  controller_.join(guard_.joined());
  if (pushed_) pushed_->join(guard_.joined());
}

void Walker::judge() {
  double squares = 0.0, weight = 0.0;
  const auto& position = controller_.workspace().marker;
  for (Eigen::Index m = 0; m < goal_.weight.size(); ++m) {
    const double own = plan_.in_levels[m] * goal_.weight[m];
    if (own == 0.0) continue;
    squares += own * (goal_.x.col(m) - position.col(m)).squaredNorm();
    weight += own;
  }
  if (weight > 0.0 && !(std::sqrt(squares / weight) <= plan_.max_error_m)) flagged_ = true;
  if (weight > 0.0 && plan_.one_sum && !plan_.settle && !flagged_) recover(squares / weight);
  // A body that is still led to the goals it had lost is not where they are.
  if (weight > 0.0 && plan_.one_sum && usual_cost_ >= 0.0 && led_.x != goal_.x &&
      squares / weight > kCostly * usual_cost_ + kCostly_m2)
    flagged_ = true;
}

}  // namespace kinemark::motion::internal
