// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/levels.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/stages/motion/control/internal/controller.h"
#include "kinemark/stages/motion/control/internal/goal_task.h"
#include "kinemark/stages/motion/control/internal/recorder.h"
#include "kinemark/stages/motion/internal/error_bars.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kNextLevel = 4.0;      // times the weight of the level below, where nothing is known
constexpr double kMostWeight = 100.0;   // beside the smallest
constexpr double kHeldBound_m = 0.005;  // of a level that holds values: 5 mm, 0.3 deg
constexpr double kLeastLeft = 0.1;      // of all numbers: with less, the pose explains nearly everything
constexpr std::int64_t kFewestFrames = 10;
constexpr double kNoiseSds = 5.0;
constexpr double kRest = 12.0;  // times 1 / omega: (1 + 12) exp(-12) of a distance is left
constexpr std::int64_t kLookedAt = 300;

/// Goals of a frame as the controller had them.
void goals_of(const Plan& plan, const Track& track, std::int64_t frame, GoalValues& goal) {
  goal.weight = track.weights.col(frame);
  for (Eigen::Index m = 0; m < goal.weight.size(); ++m)
    if (goal.weight[m] > 0.0)
      goal.x.col(m) = track.goals.x(plan.problem.first_frame + frame, plan.problem.data_marker[at(m)]);
}

/// Markers of a level, and those that goals of its tasks are made of.
std::vector<int> markers_behind(const Plan::Level& level) {
  std::vector<int> markers = level.markers;
  for (const auto& task : level.about)
    if (task.made != nullptr)
      markers.insert(markers.end(), task.made->markers().begin(), task.made->markers().end());
  return markers;
}

/// The error that nine of ten frames do not have.
double usual_error(std::vector<double>& errors) {
  if (errors.empty()) return kUsualBound_m;
  std::ranges::sort(errors);
  return errors[9 * (errors.size() - 1) / 10];
}

double time_of(const Plan& plan, const Track& track, std::int64_t frame) {
  return track.goals.time.time_s(plan.problem.first_frame + frame);
}

}  // namespace

std::vector<double> first_weights(const std::vector<TrackLevel>& levels) {
  std::vector<double> weights;
  const auto is_held = [](const TrackLevel& level) {
    return level.markers.empty() && level.tasks.empty() &&
           std::ranges::all_of(level.named, [](const NamedTask& task) {
             return task.kind == NamedTask::Kind::coordinate || task.kind == NamedTask::Kind::mass_centre;
           });
  };
  for (std::size_t i = 0; i < levels.size(); ++i)
    weights.push_back(levels[i].weight > 0.0 ? levels[i].weight
                      : is_held(levels[i])
                          ? kMostWeight
                          : std::pow(kNextLevel, static_cast<double>(levels.size() - 1 - i)));
  return weights;
}

bool needs_first_run(const Plan& plan, const TrackOptions& options) {
  return plan.asked.size() > 1 && (options.strict || !(options.levels.front().weight > 0.0));
}

void join_levels(Plan& plan, const std::vector<double>& weights) {
  double sum = 0.0, rows = 0.0;
  for (std::size_t i = 0; i < plan.asked.size(); ++i) {
    sum += weights[i] * plan.asked[i].rows();
    rows += plan.asked[i].rows();
  }
  Plan::Level all;
  plan.level_weights.clear();
  plan.level_bounds_m.clear();
  for (std::size_t i = 0; i < plan.asked.size(); ++i) {
    const auto& level = plan.asked[i];
    const double weight = weights[i] * rows / sum;
    plan.level_weights.push_back(weight);
    for (const int m : level.markers) plan.problem.weight[m] = weight * plan.marker_weight[m];
    all.markers.insert(all.markers.end(), level.markers.begin(), level.markers.end());
    all.tasks.insert(all.tasks.end(), level.tasks.begin(), level.tasks.end());
    all.about.insert(all.about.end(), level.about.begin(), level.about.end());
    for (const double w : level.task_weights) all.task_weights.push_back(weight * w);
    all.task_rows += level.task_rows;
  }
  std::ranges::sort(all.markers);
  plan.levels.clear();
  plan.levels.push_back(std::move(all));
  plan.one_sum = plan.levels.front().tasks.empty();
}

std::optional<std::vector<double>> find_level_weights(const Plan& plan, const Track& track,
                                                      const std::vector<int>& rank, int threads) {
  double seen = 0.0, explained = 0.0;
  for (Eigen::Index f = 0; f < track.weights.cols(); ++f) {
    seen += 3.0 * static_cast<double>((track.weights.col(f).array() > 0.0).count());
    explained += rank[at(f)];
  }
  if (plan.problem.frames < kFewestFrames || seen - explained < kLeastLeft * seen) return std::nullopt;
  const auto variances = estimate_variances(plan.problem, track.goals, track.states, threads);
  const Eigen::VectorXd information = information_of(plan.problem.model, variances);
  std::vector<double> weights;
  for (const auto& level : plan.asked) {
    double variance = 0.0;
    const auto markers = markers_behind(level);
    for (const int m : markers) variance += 1.0 / information[m];
    if (markers.empty() && !level.is_held()) return std::nullopt;
    weights.push_back(markers.empty() ? 0.0 : static_cast<double>(markers.size()) / variance);
  }
  const double most = std::ranges::max(weights);
  if (!(most > 0.0)) return std::nullopt;
  double least = most;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = std::max(weights[i], most / kMostWeight);
    if (!plan.asked[i].is_held()) least = std::min(least, weights[i]);
  }
  // A value that is held has no variance.
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (plan.asked[i].is_held()) weights[i] = kMostWeight * least;
  return weights;
}

LevelErrors::LevelErrors(const Plan& plan)
    : plan_(plan), errors_(Eigen::VectorXd::Constant(static_cast<Eigen::Index>(plan.asked.size()), kNaN)) {}

const Eigen::VectorXd& LevelErrors::find(const model::Workspace& w, const GoalValues& goal, double time_s) {
  for (std::size_t i = 0; i < plan_.asked.size(); ++i) {
    const auto& level = plan_.asked[i];
    double squares = 0.0, weight = 0.0;
    for (const int m : level.markers) {
      if (!(goal.weight[m] > 0.0)) continue;
      squares += goal.weight[m] * (goal.x.col(m) - w.marker.col(m)).squaredNorm();
      weight += goal.weight[m];
    }
    for (std::size_t t = 0; t < level.tasks.size(); ++t) {
      level.evaluate(t, plan_.problem, w, goal, time_s, rows_);
      squares += rows_.weight.dot(rows_.error.cwiseAbs2());
      const double points =
          level.about[t].made != nullptr ? level.about[t].made->points() : level.about[t].points;
      weight += rows_.weight.maxCoeff() > 0.0 ? points : 0.0;
    }
    errors_[static_cast<Eigen::Index>(i)] = weight > 0.0 ? std::sqrt(squares / weight) : kNaN;
  }
  return errors_;
}

std::vector<double> find_level_bounds(const Plan& plan, const Track& track, const Eigen::VectorXd& noise) {
  const auto& model = plan.problem.model;
  model::Workspace w(model);
  LevelErrors errors(plan);
  GoalValues goal(model.marker_count());
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(model.speed_count());
  std::vector<std::vector<double>> found(plan.asked.size());
  const std::int64_t stride = std::max<std::int64_t>(1, plan.problem.frames / kLookedAt);
  for (std::int64_t f = 0; f < plan.problem.frames; f += stride) {
    goals_of(plan, track, f, goal);
    model::kinematics(model, w, track.states.col(f));
    model::velocities(model, w, still);
    const auto& error = errors.find(w, goal, time_of(plan, track, f));
    for (std::size_t i = 0; i < found.size(); ++i)
      if (const double e = error[static_cast<Eigen::Index>(i)]; std::isfinite(e)) found[i].push_back(e);
  }
  std::vector<double> bounds;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (plan.asked[i].is_held()) {
      bounds.push_back(kHeldBound_m);
      continue;
    }
    double variance = 0.0;
    const auto markers = markers_behind(plan.asked[i]);
    for (const int m : markers) variance += noise[m];
    const auto count = static_cast<double>(std::max<std::size_t>(1, markers.size()));
    bounds.push_back(kNoiseSds * std::sqrt(variance / count) + usual_error(found[i]));
  }
  return bounds;
}

std::vector<LevelCheck> check_strict(const Plan& strict, const Track& track) {
  Controller body(strict);
  LevelErrors errors(strict);
  GoalValues goal(strict.problem.model.marker_count());
  const auto every = std::max<std::int64_t>(1, std::llround(strict.rate_hz));
  const int steps = static_cast<int>(std::ceil(kRest * strict.kd / (2.0 * strict.kp * strict.step_s)));
  std::vector<LevelCheck> checks;
  for (std::int64_t f = 0; f < strict.problem.frames; f += every) {
    if (!(track.weights.col(f).maxCoeff() > 0.0)) continue;
    goals_of(strict, track, f, goal);
    const double time_s = time_of(strict, track, f);
    body.start(track.states.col(f), goal, time_s);
    bool goes_on = body.evaluate(goal, time_s);
    for (int s = 0; s < steps && goes_on; ++s) {
      body.advance(strict.step_s);
      goes_on = body.evaluate(goal, time_s);
    }
    LevelCheck check{.time_s = time_s, .errors_m = errors.found()};
    if (goes_on)
      check.errors_m = errors.find(body.workspace(), goal, time_s);
    else
      check.errors_m.setConstant(std::numeric_limits<double>::infinity());
    checks.push_back(std::move(check));
  }
  return checks;
}

std::string describe_checks(const Plan& strict, const std::vector<LevelCheck>& checks, bool& most) {
  std::size_t bad = 0, level = 0;
  double worst = 0.0;
  const LevelCheck* where = nullptr;
  for (const auto& check : checks) {
    bool is_bad = false;
    for (std::size_t i = 0; i < strict.level_bounds_m.size(); ++i) {
      const double beyond = check.errors_m[static_cast<Eigen::Index>(i)] / strict.level_bounds_m[i];
      if (!(beyond > 1.0)) continue;
      is_bad = true;
      if (beyond <= worst) continue;
      worst = beyond;
      level = i;
      where = &check;
    }
    bad += is_bad ? 1 : 0;
  }
  most = 2 * bad > checks.size();
  if (where == nullptr) return {};
  return fmt::format(
      "strict levels contradict one another in {} of {} poses looked at before the run: level {} comes no "
      "nearer to its goals than {:.1f} mm at {:.2f} s (bound {:.1f} mm){}",
      bad, checks.size(), level + 1, 1e3 * where->errors_m[static_cast<Eigen::Index>(level)], where->time_s,
      1e3 * strict.level_bounds_m[level],
      most ? "; all levels are followed in one sum of squares instead" : "");
}

}  // namespace kinemark::motion::internal
