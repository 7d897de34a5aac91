// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/plan.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/control/internal/body_name.h"
#include "kinemark/stages/motion/control/internal/goal_task.h"
#include "kinemark/stages/motion/control/internal/levels.h"
#include "kinemark/stages/motion/control/internal/place_tasks.h"
#include "kinemark/stages/motion/internal/held_speeds.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kRestWeight =
    1e-6;  // m^2/rad^2, on the first pose only: for coordinates that the markers do not determine
constexpr double kIdleLever = 0.01;  // m per rad
constexpr double kIdleShare = 0.05;  // of the poses
constexpr int kMostSteps = 100000;   // per frame
constexpr int kPosesAround = 20;
constexpr double kAround = 0.5;  // rad or m
constexpr std::uint64_t kStream = 0x706f7365;
constexpr double kNoMass = 1e-12;  // kg, kg m^2

std::vector<std::string> marker_names(const model::Model& model) {
  std::vector<std::string> names;
  for (const auto& marker : model.description().markers) names.push_back(marker.name);
  return names;
}

/// Level of every marker that some level names; "*" is left for later.
Result<std::map<std::string, std::size_t>> name_levels(const model::Model& model,
                                                       const std::vector<TrackLevel>& levels) {
  std::map<std::string, std::size_t> level_of;
  for (std::size_t i = 0; i < levels.size(); ++i)
    for (const auto& name : levels[i].markers) {
      if (name != "*" && model.description().find_marker(name) < 0)
        return fail(Code::bad_input,
                    fmt::format("level {} names marker '{}', which the model does not have{}", i + 1, name,
                                nearest_of(name, marker_names(model))));
      const auto [other, fresh] = level_of.try_emplace(name, i);
      if (!fresh)
        return fail(Code::bad_input,
                    fmt::format("marker '{}' is named in level {} and again in level {}; once is enough",
                                name, other->second + 1, i + 1));
    }
  return level_of;
}

/// Which markers take part, in a level or in the goals of tasks; the others get the weight 0, and `left_out`
/// says why.
Status choose_markers(const model::Model& model, const std::map<std::string, std::size_t>& level_of,
                      const std::set<std::string>& of_tasks, IkOptions& options,
                      std::vector<std::string>& warnings, std::map<std::string, std::string>& left_out) {
  for (int m = 0; m < model.marker_count(); ++m) {
    const auto& name = model.description().markers[at(m)].name;
    const bool named = level_of.contains(name);
    if (is_welded(model, model.markers()[at(m)].body)) {
      if (named)
        return fail(Code::bad_input,
                    fmt::format("marker '{}' sits on a body that is welded to the ground; it cannot be moved "
                                "to a goal",
                                name));
      warnings.push_back(
          fmt::format("marker '{}' sits on a body that is welded to the ground and is left out", name));
      left_out[name] = "its body is welded to the ground";
    } else if (!named && !level_of.contains("*") && !of_tasks.contains(name)) {
      left_out[name] = "in no level";
    } else {
      continue;
    }
    std::erase_if(options.marker_weights, [&](const MarkerWeight& w) { return w.marker == name; });
    options.marker_weights.push_back({name, 0.0});
  }
  return {};
}

Status place_levels(const std::map<std::string, std::size_t>& level_of, const std::vector<TrackLevel>& levels,
                    const Eigen::VectorXd& rest_pose, Plan& plan) {
  const auto& model = plan.problem.model;
  plan.levels.resize(levels.size());
  plan.in_levels.setZero(model.marker_count());
  const auto rest = level_of.find("*");
  for (int m = 0; m < model.marker_count(); ++m) {
    const auto named = level_of.find(model.description().markers[at(m)].name);
    if (named == level_of.end() && rest == level_of.end()) continue;
    plan.levels[named != level_of.end() ? named->second : rest->second].markers.push_back(m);
    plan.in_levels[m] = 1.0;
  }
  for (std::size_t i = 0; i < levels.size(); ++i) {
    auto& level = plan.levels[i];
    level.tasks = levels[i].tasks;
    level.about.resize(level.tasks.size());
    place_named(levels[i], rest_pose, plan, level);
    for (const auto& task : level.tasks) {
      if (auto status = task->bind(model); !status) return fail_at(task->name(), status.error());
      level.task_rows += task->rows();
    }
    level.task_weights.assign(level.tasks.size(), 1.0);
    if (level.rows() == 0)
      return fail(Code::bad_input,
                  fmt::format("level {} has no tasks: the recording holds none of its markers", i + 1));
  }
  for (const auto& [name, level] : level_of)
    if (name != "*" && model.description().find_marker(name) < 0)
      plan.problem.fit.warnings.push_back(fmt::format(
          "marker '{}' of level {} is not in the recording, never seen, or weighs 0", name, level + 1));
  return {};
}

Status set_gains(const TrackOptions& options, Plan& plan) {
  plan.kp = options.kp > 0.0 ? options.kp : options.omega_rad_s * options.omega_rad_s;
  plan.kd = options.kd > 0.0 ? options.kd : 2.0 * options.omega_rad_s;
  plan.posture_kp = options.posture_kp;
  plan.posture_kd = options.posture_kd;
  // Half of the stability limit of the constant-acceleration update: kd h < 2, kp h < 2 kd. Critically
  // damped: omega h
  // <= 0.5.
  const double longest = std::min(1.0 / plan.kd, plan.kd / plan.kp);
  const double interval = 1.0 / plan.rate_hz;
  const double wished = options.step_s > 0.0 ? options.step_s : longest;
  const double count = std::ceil(interval / wished * (1.0 - 1e-9));
  if (!(count <= kMostSteps))
    return fail(Code::usage, fmt::format("a step of {:g} s cuts a frame of {:g} s into more than {} steps",
                                         wished, interval, kMostSteps));
  plan.steps_per_frame = std::max(1, static_cast<int>(count));
  plan.step_s = interval / plan.steps_per_frame;
  if (plan.step_s > longest * (1.0 + 1e-9))
    return fail(
        Code::usage,
        fmt::format("the gains are unstable for the step: kp {:g} 1/s^2 and kd {:g} 1/s (omega {:g} "
                    "rad/s) need a step of {:.4g} s at most (omega x step <= 0.5), and it is {:.4g} s",
                    plan.kp, plan.kd, std::sqrt(plan.kp), longest, plan.step_s));
  if (plan.posture_kd * plan.step_s > 1.0 || plan.posture_kp * plan.step_s > plan.posture_kd + 1e-12)
    if (plan.posture_kp > 0.0 || plan.posture_kd > 0.0)
      return fail(Code::usage,
                  fmt::format("the posture's gains are unstable for the step of {:.4g} s: kp {:g} "
                              "1/s^2 and kd {:g} 1/s; need kd x step <= 1 and kp x step <= kd",
                              plan.step_s, plan.posture_kp, plan.posture_kd));
  return {};
}

/// Rest pose: the model's defaults, except for the coordinates given in the options.
Result<Eigen::VectorXd> rest_coordinates(const model::Model& model, const TrackOptions& options) {
  Eigen::VectorXd q(model.coordinate_count());
  for (int c = 0; c < q.size(); ++c) q[c] = model.description().coordinates[at(c)].default_value;
  for (const auto& wish : options.rest_pose) {
    const int c = model.description().find_coordinate(wish.coordinate);
    if (c < 0)
      return fail(Code::bad_input,
                  fmt::format("the rest pose names coordinate '{}', which the model does not "
                              "have",
                              wish.coordinate));
    if (!std::isfinite(wish.value))
      return fail(Code::bad_input,
                  fmt::format("the rest pose of coordinate '{}' is not a number", wish.coordinate));
    q[c] = wish.value;
  }
  return q;
}

Status lock_named(const TrackOptions& options, Plan& plan) {
  const auto& model = plan.problem.model;
  for (const auto& name : options.locked) {
    const int c = model.description().find_coordinate(name);
    if (c < 0)
      return fail(Code::bad_input,
                  fmt::format("coordinate '{}' is to be locked, but the model does not have it", name));
    const int speed = model.coordinates()[at(c)].speed_idx;
    if (speed < 0)
      return fail(
          Code::not_supported,
          fmt::format("coordinate '{}' cannot be locked: it belongs to a free root or follows another",
                      name));
    plan.problem.fixed_speed[at(speed)] = 1;
    plan.locked.push_back(c);
  }
  return {};
}

}  // namespace

bool Plan::Level::is_held() const {
  return markers.empty() && std::ranges::all_of(about, [](const About& task) { return task.is_held; });
}

void Plan::Level::evaluate(std::size_t t, const Problem& problem, const model::Workspace& w,
                           const GoalValues& goal, double time_s, TaskRows& rows,
                           Eigen::MatrixXd* gains) const {
  rows.resize(tasks[t]->rows(), problem.model.speed_count());
  if (gains != nullptr) gains->resize(tasks[t]->rows(), 0);
  if (about[t].made != nullptr)
    about[t].made->follow(problem.model, w, goal, problem.weight, rows, gains);
  else
    tasks[t]->evaluate(problem.model, w, time_s, rows);
  rows.weight *= task_weights[t];
}

void Plan::apply_locks(Eigen::VectorXd& x) const {
  for (const int c : locked) {
    const int row = problem.model.coordinates()[at(c)].state_idx;
    x[row] = rest[row];
  }
}

GoalFilter make_filter(double rate_hz, const TrackOptions& options) {
  return {rate_hz, options.cutoff_hz, options.lookahead_s, options.fade_s};
}

Result<Plan> make_plan(const model::Model& model, const data::Trajectories& markers,
                       const TrackOptions& options) {
  if (auto status = options.check(); !status) return std::unexpected(status.error());
  Plan plan;
  auto levels = options.levels;
  if (levels.empty()) levels.push_back({.markers = {"*"}});
  const auto level_of = name_levels(model, levels);
  if (!level_of) return std::unexpected(level_of.error());

  auto& ik = plan.start_options;
  ik.marker_weights = options.marker_weights;
  ik.limits = options.limits;
  ik.first_time_s = options.first_time_s;
  ik.last_time_s = options.last_time_s;
  ik.seed = options.seed;
  ik.starts = options.starts;
  ik.threads = options.threads;
  std::vector<std::string> warnings;
  std::map<std::string, std::string> left_out;
  const auto of_tasks = markers_of_tasks(model, options);
  if (!of_tasks) return std::unexpected(of_tasks.error());
  if (auto status = choose_markers(model, *level_of, *of_tasks, ik, warnings, left_out); !status)
    return std::unexpected(status.error());
  auto rest = rest_coordinates(model, options);
  if (!rest) return std::unexpected(rest.error());
  for (int c = 0; c < model.coordinate_count(); ++c)
    if (model.coordinates()[at(c)].speed_idx >= 0)
      ik.coordinate_tasks.push_back({.coordinate = model.description().coordinates[at(c)].name,
                                     .weight = kRestWeight,
                                     .value = (*rest)[c]});
  auto problem = make_problem(model, markers, ik);
  if (!problem) return std::unexpected(problem.error());
  plan.problem = std::move(*problem);
  for (const auto& coordinate : plan.problem.prescribed)
    warnings.push_back(
        fmt::format("coordinate '{}' is prescribed by a function of time; tracking holds it at the rest pose",
                    coordinate.name));
  plan.problem.prescribed.clear();
  auto& fit = plan.problem.fit;
  fit.warnings.insert(fit.warnings.end(), warnings.begin(), warnings.end());
  for (auto& marker : fit.excluded)
    if (const auto why = left_out.find(marker.name); marker.why == data::kNoWeight && why != left_out.end())
      marker.why = why->second;
  plan.rate_hz = markers.time.rate_hz;
  plan.damping = {.damping = options.damping, .truncation = options.truncation};
  plan.feed_forward = options.feed_forward;
  plan.max_speed = options.max_speed;
  plan.max_error_m = options.max_error_m;
  plan.ease_s = std::max(options.fade_s, 1.0 / plan.rate_hz);
  if (auto status = place_levels(*level_of, levels, *rest, plan); !status)
    return std::unexpected(status.error());
  plan.asked = plan.levels;
  plan.marker_weight = plan.problem.weight;
  if (plan.asked.size() > 1 && options.strict)
    plan.level_bounds_m.assign(plan.asked.size(),
                               options.level_bound_m > 0.0 ? options.level_bound_m : kUsualBound_m);
  if (plan.asked.size() > 1 && !options.strict) join_levels(plan, first_weights(options.levels));
  // Strict levels and goals that are not points have no single sum of squares to settle.
  plan.one_sum = plan.levels.size() == 1 && plan.levels.front().tasks.empty();
  plan.settle = options.settle && plan.one_sum;
  if (auto status = set_gains(options, plan); !status) return std::unexpected(status.error());
  for (int c = 0; c < rest->size(); ++c) {
    const int speed = model.coordinates()[at(c)].speed_idx;
    if (speed >= 0) (*rest)[c] = std::clamp((*rest)[c], plan.problem.lower[speed], plan.problem.upper[speed]);
  }
  plan.rest = model::state_from_coordinates(plan.problem.model, *rest);
  if (auto status = lock_named(options, plan); !status) return std::unexpected(status.error());
  return plan;
}

std::vector<Eigen::VectorXd> poses_around(const Plan& plan, const Eigen::VectorXd& x) {
  const auto& p = plan.problem;
  Random random(plan.start_options.seed, kStream);
  std::vector<Eigen::VectorXd> poses;
  for (int i = 0; i < kPosesAround; ++i) {
    Eigen::VectorXd pose = x;
    for (const auto& c : p.model.coordinates()) {
      const double u = random.uniform(-kAround, kAround);
      if (c.speed_idx < 0 || p.fixed_speed[at(c.speed_idx)] != 0) continue;
      pose[c.state_idx] = std::clamp(pose[c.state_idx] + u, p.lower[c.speed_idx], p.upper[c.speed_idx]);
    }
    poses.push_back(std::move(pose));
  }
  return poses;
}

void lock_idle(Plan& plan, const IdlePoses& idle_poses) {
  const auto& model = plan.problem.model;
  model::Workspace w(model);
  Eigen::MatrixXd J;
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(model.speed_count());
  TaskRows rows;
  GoalValues reached(model.marker_count());  // goals where the markers are
  reached.weight = plan.problem.weight;
  Eigen::VectorXd squares, most;
  // Poses in which each speed moves no goal.
  const auto idle_in = [&](const std::vector<Eigen::VectorXd>& poses, bool with_markers) {
    Eigen::VectorXi idle = Eigen::VectorXi::Zero(model.speed_count());
    for (const auto& x : poses) {
      model::kinematics(model, w, x);
      model::velocities(model, w, still);
      squares.setZero(model.speed_count());
      if (with_markers) {
        model::marker_jacobian(model, w, J);
        for (Eigen::Index m = 0; m < plan.in_levels.size(); ++m)
          if (plan.in_levels[m] > 0.0) squares += J.middleRows<3>(3 * m).colwise().squaredNorm().transpose();
      }
      reached.x = w.marker;
      for (const auto& level : plan.asked)
        for (std::size_t t = 0; t < level.tasks.size(); ++t) {
          most.setZero(model.speed_count());
          for (const double time_s : idle_poses.times_s) {
            level.evaluate(t, plan.problem, w, reached, time_s, rows);
            for (Eigen::Index k = 0; k < most.size(); ++k)
              most[k] = std::max(most[k], rows.weight.dot(rows.jacobian.col(k).cwiseAbs2()));
          }
          squares += most;
        }
      for (Eigen::Index k = 0; k < idle.size(); ++k) idle[k] += squares[k] < kIdleLever * kIdleLever;
    }
    return idle;
  };
  const Eigen::VectorXi followed = idle_in(idle_poses.followed, true),
                        around = idle_in(idle_poses.around, false);
  const auto often = [](int idle, const std::vector<Eigen::VectorXd>& poses) {
    return poses.empty() || idle > kIdleShare * static_cast<double>(poses.size());
  };
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const int speed = model.coordinates()[at(c)].speed_idx;
    if (speed < 0 || plan.problem.fixed_speed[at(speed)] != 0) continue;
    if (!often(followed[speed], idle_poses.followed) || !often(around[speed], idle_poses.around)) continue;
    plan.problem.fixed_speed[at(speed)] = 1;
    plan.locked.push_back(c);
  }
}

Status check_mass(const Plan& plan, const Eigen::VectorXd& x) {
  const auto& model = plan.problem.model;
  model::Workspace w(model);
  Eigen::MatrixXd M;
  model::kinematics(model, w, x);
  model::mass_matrix(model, w, M);
  const auto massless = [&](const std::string& what) {
    return fail(Code::bad_input, fmt::format("model '{}' has no mass behind {}; direct marker control needs "
                                             "masses and inertias",
                                             model.description().name, what));
  };
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const int speed = model.coordinates()[at(c)].speed_idx;
    if (speed >= 0 && plan.problem.fixed_speed[at(speed)] == 0 && M(speed, speed) < kNoMass)
      return massless(fmt::format("coordinate '{}'", model.description().coordinates[at(c)].name));
  }
  for (const auto& free : model.free_joints())
    if (M.diagonal().segment<6>(free.speed_idx).minCoeff() < kNoMass) return massless("its free root");
  hold_speeds(M, plan.problem.fixed_speed);
  if (Eigen::LLT<Eigen::MatrixXd>(M).info() != Eigen::Success)
    return massless("some combination of its coordinates");
  return {};
}

}  // namespace kinemark::motion::internal
