// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/recorder.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/model/coordinate_rates.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion::internal {
namespace {

using data::FrameStatus;

constexpr std::int64_t kProgressEvery = 100;  // frames

}  // namespace

Readout::Readout(const model::Model& model) : model_(model), w_(model), near_(model.coordinate_count()) {
  for (int c = 0; c < model.coordinate_count(); ++c)
    near_[c] = model.description().coordinates[at(c)].default_value;
  q_ = near_;
  tau_.setZero(model.coordinate_count());
}

void Readout::find(const Eigen::VectorXd& x, const Eigen::VectorXd& v, const Eigen::VectorXd& a) {
  model::coordinates_from_state(model_, x, near_, q_);
  near_ = q_;
  model::kinematics(model_, w_, x);
  model::velocities(model_, w_, v);
  model::rates_from_speeds(model_, w_, q_, v, a, rate_, acceleration_);
  model::inverse_dynamics(model_, w_, a, force_);
  for (int c = 0; c < model_.coordinate_count(); ++c) {
    const int speed = model_.coordinates()[at(c)].speed_idx;
    tau_[c] = speed >= 0 ? force_[speed] : std::numeric_limits<double>::quiet_NaN();
  }
  model::coordinate_jacobian(model_, w_, q_, E_);
  for (const auto& free : model_.free_joints()) {
    // Power is the same in both: E'tau = force.
    for (int block = 0; block < 2; ++block) {
      const int* coordinate = block == 0 ? free.translation_coordinate : free.rotation_coordinate;
      const int speed = free.speed_idx + 3 * block;
      Eigen::Matrix3d E;
      for (int i = 0; i < 3; ++i) E.row(i) = E_.block<1, 3>(coordinate[i], speed);
      const Eigen::Vector3d tau = E.transpose().inverse() * force_.segment<3>(speed);
      for (int i = 0; i < 3; ++i) tau_[coordinate[i]] = tau[i];
    }
  }
}

Recorder::Recorder(const Plan& plan, const data::Trajectories& markers, Walker& walker, Track& track,
                   TrackResult& result)
    : plan_(plan),
      markers_(markers),
      walker_(walker),
      track_(track),
      result_(result),
      readout_(plan.problem.model) {
  auto& motion = result.motion;
  const auto F = plan.problem.frames;
  const auto n = static_cast<std::int64_t>(motion.coordinates.size());
  for (auto* column : {&motion.q, &motion.qd, &motion.qdd, &motion.tau}) column->assign(at(F * n), 0.0);
  motion.marker_error.assign(at(3 * F * plan.problem.model.marker_count()), kNaN);
  motion.status.assign(at(F), FrameStatus::no_markers);
  track.states.resize(plan.problem.model.state_count(), F);
  result.rank.assign(at(F), 0);
  result.smallest_singular.assign(at(F), 0.0);
  for (const auto& level : plan.asked)
    for (const auto& task : level.about)
      if (!task.text.empty()) result.tasks.push_back({.text = task.text, .is_angle = task.is_angle});
  task_squares_.assign(result.tasks.size(), 0.0);
  task_frames_.assign(result.tasks.size(), 0);
  if (plan.asked.size() < 2) return;
  result.levels.resize(plan.asked.size());
  for (std::size_t i = 0; i < result.levels.size(); ++i) {
    auto& level = result.levels[i];
    if (!plan.level_weights.empty()) level.weight = plan.level_weights[i];
    if (!plan.level_bounds_m.empty()) level.bound_m = plan.level_bounds_m[i];
  }
  result.level_error.assign(at(F) * plan.asked.size(), kNaN);
  result.relaxed.assign(at(F), 0);
}

bool Recorder::run(const Eigen::VectorXd& x, const Progress& progress) {
  walker_.begin(x, 0);
  const std::int64_t solves_at_first = walker_.solves();
  store();
  for (std::int64_t f = 1; f < plan_.problem.frames; ++f) {
    if (progress && f % kProgressEvery == 0 && !progress(f, plan_.problem.frames)) return false;
    walker_.next();
    store();
  }
  if (goals_ == 0) result_.rms_goal_error_m = kNaN;
  close_levels();
  result_.restarts = walker_.restarts();
  result_.solves += walker_.solves() - solves_at_first;
  result_.steps = walker_.controller().steps();
  return true;
}

void Recorder::store() {
  auto& motion = result_.motion;
  const std::int64_t f = walker_.frame();
  auto& body = walker_.controller();
  readout_.find(body.x(), body.v(), body.a());
  const auto keep = [&](Array<double>& to, const Eigen::VectorXd& from) {
    std::copy(from.data(), from.data() + from.size(), to.data() + motion.index(f, 0));
  };
  keep(motion.q, readout_.q());
  keep(motion.qd, readout_.rate());
  keep(motion.qdd, readout_.acceleration());
  keep(motion.tau, readout_.tau());
  track_.states.col(f) = body.x();
  result_.rank[at(f)] = body.rank();
  result_.smallest_singular[at(f)] = body.smallest_singular();
  store_marker_errors(f);
  store_levels(f);
  store_tasks();
  if (walker_.flagged()) {
    motion.status[at(f)] = FrameStatus::not_converged;
    ++result_.flagged_frames;
  } else if (walker_.any_goal()) {
    motion.status[at(f)] =
        body.rank() < result_.free_speeds ? FrameStatus::underdetermined : FrameStatus::converged;
    if (walker_.beyond()) motion.status[at(f)] = FrameStatus::not_converged;
  }
}

void Recorder::store_levels(std::int64_t f) {
  if (result_.levels.empty()) return;
  result_.relaxed[at(f)] = walker_.relaxed() ? 1 : 0;
  for (std::size_t i = 0; i < result_.levels.size(); ++i) {
    auto& level = result_.levels[i];
    const double error = walker_.level_errors()[static_cast<Eigen::Index>(i)];
    result_.level_error[at(f) * result_.levels.size() + i] = error;
    if (!std::isfinite(error)) continue;
    level.max_error_m = std::max(level.max_error_m, error);
    if (!walker_.guard().is_beyond(i, error)) continue;
    ++level.beyond;
    if (walker_.relaxed() && walker_.guard().settled()) ++level.unmet;
  }
}

void Recorder::store_tasks() {
  std::size_t i = 0;
  for (const auto& level : plan_.asked)
    for (std::size_t t = 0; t < level.tasks.size(); ++t) {
      if (level.about[t].text.empty()) continue;
      level.evaluate(t, plan_.problem, walker_.controller().workspace(), walker_.goal(), walker_.time_s(),
                     rows_);
      if (rows_.weight.maxCoeff() > 0.0) {
        auto& task = result_.tasks[i];
        task_squares_[i] += rows_.error.squaredNorm();
        ++task_frames_[i];
        task.max_error = std::max(task.max_error, rows_.error.norm());
        task.rms_error = std::sqrt(task_squares_[i] / static_cast<double>(task_frames_[i]));
      }
      ++i;
    }
}

void Recorder::close_levels() {
  const std::size_t L = result_.levels.size();
  for (std::size_t i = 0; i < L; ++i) {
    double squares = 0.0, count = 0.0;
    for (std::size_t k = i; k < result_.level_error.size(); k += L)
      if (const double e = result_.level_error[k]; std::isfinite(e)) squares += e * e, count += 1.0;
    if (count > 0.0) result_.levels[i].rms_error_m = std::sqrt(squares / count);
  }
  result_.relaxations = walker_.guard().trips() + (plan_.levels_given_up ? 1 : 0);
}

void Recorder::store_marker_errors(std::int64_t f) {
  const auto M = static_cast<std::int64_t>(plan_.problem.model.marker_count());
  const auto& position = walker_.controller().workspace().marker;
  for (std::int64_t m = 0; m < M; ++m) {
    const auto in_data = plan_.problem.data_marker[at(m)];
    if (!markers_.present(plan_.problem.first_frame + f, in_data)) continue;
    const Eigen::Vector3d error = markers_.x(plan_.problem.first_frame + f, in_data) - position.col(m);
    std::copy(error.data(), error.data() + 3, result_.motion.marker_error.data() + (f * M + m) * 3);
    if (walker_.goal().weight[m] <= 0.0) continue;
    const double miss = (walker_.goal().x.col(m) - position.col(m)).norm();
    goal_squares_ += miss * miss;
    ++goals_;
    result_.max_goal_error_m = std::max(result_.max_goal_error_m, miss);
    result_.rms_goal_error_m = std::sqrt(goal_squares_ / static_cast<double>(goals_));
  }
}

}  // namespace kinemark::motion::internal
