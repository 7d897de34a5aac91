// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/track.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/stages/motion/control/internal/accuracy.h"
#include "kinemark/stages/motion/control/internal/followed_run.h"
#include "kinemark/stages/motion/control/internal/levels.h"
#include "kinemark/stages/motion/control/internal/propose_levels.h"
#include "kinemark/stages/motion/control/internal/recorder.h"
#include "kinemark/stages/motion/control/internal/step_error.h"
#include "kinemark/stages/motion/control/internal/track_bars.h"
#include "kinemark/stages/motion/internal/judged_frames.h"
#include "kinemark/stages/motion/internal/marker_account.h"
#include "kinemark/stages/motion/internal/sample_findings.h"

namespace kinemark::motion {
namespace {

using internal::FollowedRun;
using internal::GoalFilter;
using internal::JudgedRun;
using internal::Plan;
using internal::Track;
using internal::Walker;

Status check_derivatives(const data::Trajectories& markers, const TrackOptions& options) {
  if (options.derivatives == nullptr) return {};
  if (auto status = options.derivatives->validate(markers); !status) return status;
  if (options.derivatives->velocity.empty() || options.derivatives->acceleration.empty())
    return fail(Code::bad_input, "the derivatives given lack velocity or acceleration; need both");
  return {};
}

/// Deviations and bounds are those of the samples that remain.
void forget_rejected(const Plan& plan, const data::Trajectories& kept, Track& track) {
  const auto& p = plan.problem;
  for (std::int64_t f = 0; f < p.frames; ++f)
    for (int m = 0; m < p.model.marker_count(); ++m) {
      const int d = p.data_marker[at(m)];
      if (kept.state[kept.index(p.first_frame + f, d)] != data::SampleState::rejected) continue;
      track.weights(m, f) = 0.0;
      track.goals.set_missing(p.first_frame + f, d, data::SampleState::rejected);
    }
}

/// What steps cost is measured, by finer ones, where it may be too much.
void warn_of_step(const data::Trajectories& goals, const GoalFilter& filter, const TrackOptions& options,
                  FollowedRun& run) {
  auto& [plan, track, result] = run;
  const auto& model = plan.problem.model;
  const double known = internal::stated_error(model, result.motion);
  if (!(internal::step_error(model, result.motion, plan.step_s, std::sqrt(plan.kp)) >
        internal::tolerated_cost(known)))
    return;
  const Plan finer = internal::with_finer_steps(plan);
  Walker walker(finer, filter, plan.problem.frames, result.motion.time.t0_s);
  if (options.derivatives != nullptr) walker.use_derivatives(*options.derivatives, goals.markers());
  internal::fill_window(plan, goals, walker.samples());
  auto warning = internal::warn_of_step(plan, internal::step_cost(plan, track.states, walker), known);
  if (!warning.empty()) result.fit.warnings.push_back(std::move(warning));
}

/// Noise of the goals, M, variance per axis, m^2.
Eigen::VectorXd noise_of_goals(const JudgedRun& run, const data::Trajectories& markers,
                               const GoalFilter& filter, const TrackOptions& options) {
  const auto& [plan, track, result] = run.body;
  const Eigen::Index M = plan.problem.model.marker_count();
  const double given = options.marker_noise_sd_m * options.marker_noise_sd_m;
  if (given > 0.0) return Eigen::VectorXd::Constant(M, given * filter.noise_in_goal());
  const bool filtered = options.derivatives == nullptr && filter.noise_in_rest() >= 1e-3;
  if (!filtered) return internal::goal_noise(plan, track, filter, options, {}).own;
  return filter.noise_in_goal() *
         internal::white_noise(plan, run.kept(markers), track, filter, options.threads, result.motion);
}

/// What a run in which all levels counted alike says of them: weights, or bounds and whether they can be
/// kept.
void choose_levels(const JudgedRun& first, const data::Trajectories& markers, const GoalFilter& filter,
                   const TrackOptions& options, Plan& plan) {
  const auto& [joined, track, result] = first.body;
  if (!options.strict) {
    if (const auto found = internal::find_level_weights(joined, track, result.rank, options.threads))
      internal::join_levels(plan, *found);
    return;
  }
  if (!(options.level_bound_m > 0.0))
    plan.level_bounds_m =
        internal::find_level_bounds(joined, track, noise_of_goals(first, markers, filter, options));
  auto warning = internal::describe_checks(plan, internal::check_strict(plan, track), plan.levels_given_up);
  if (!warning.empty()) plan.problem.fit.warnings.push_back(std::move(warning));
}

/// The run that counts, with several levels: after one in which they counted alike.
Status run_levels(const Plan& plan, const data::Trajectories& markers, const GoalFilter& filter,
                  const TrackOptions& options, const Progress& progress, JudgedRun& run) {
  FollowedRun next{.plan = plan, .track = {}, .result = {}};
  choose_levels(run, markers, filter, options, next.plan);
  if (auto status =
          internal::follow(markers, {.kept = run.kept(markers), .goals = run.goals(markers, options)}, filter,
                           options, progress, next);
      !status)
    return status;
  next.result.solves += run.body.result.solves;
  next.result.solve_seconds += run.body.result.solve_seconds;
  run.body = std::move(next);
  return {};
}

/// Frames in which a level was beyond its bound.
void add_level_findings(TrackResult& result) {
  const std::size_t L = result.levels.size();
  for (std::size_t i = 0; i < L; ++i) {
    const auto& level = result.levels[i];
    if (level.beyond == 0) continue;
    data::Finding finding{.kind = data::FindingKind::flagged,
                          .subject = fmt::format("level {}", i + 1),
                          .size = static_cast<double>(level.beyond)};
    for (std::size_t f = 0; f < result.relaxed.size(); ++f)
      if (result.level_error[f * L + i] > level.bound_m)
        finding.frames.push_back(static_cast<std::int64_t>(f));
    finding.first_frame = finding.frames.front();
    finding.last_frame = finding.frames.back();
    finding.description = fmt::format(
        "level {} was farther from its goals than its bound of {:.1f} mm in {} of {} frames ({:.2f} to "
        "{:.2f} "
        "s), up to {:.1f} mm{}",
        i + 1, 1e3 * level.bound_m, level.beyond, result.motion.frames(),
        result.motion.time.time_s(finding.first_frame), result.motion.time.time_s(finding.last_frame),
        1e3 * level.max_error_m,
        level.unmet > 0
            ? fmt::format("; in {} of them it cannot be met, not even by all levels in one sum of squares",
                          level.unmet)
            : "");
    result.fit.findings.push_back(std::move(finding));
  }
}

void warn_of_relaxing(TrackResult& result) {
  const auto frames = std::ranges::count(result.relaxed, std::uint8_t{1});
  if (frames == 0) return;
  result.fit.warnings.push_back(fmt::format(
      "strict levels were followed in one sum of squares in {} of {} frames ({} times begun){}", frames,
      result.motion.frames(), result.relaxations, result.relaxed.back() != 0 ? ", to the end" : ""));
}

Result<TrackResult> track_as_given(const model::Model& model, const data::Trajectories& markers,
                                   const TrackOptions& options, const Progress& progress) {
  auto plan = internal::make_plan(model, markers, options);
  if (!plan) return std::unexpected(plan.error());
  if (auto status = check_derivatives(markers, options); !status) return std::unexpected(status.error());
  if (plan->problem.frames < 2)
    return fail(Code::bad_input, "the time range holds one frame; direct marker control needs two at least");

  const GoalFilter filter = internal::make_filter(plan->rate_hz, options);
  const bool two_runs = internal::needs_first_run(*plan, options);
  Plan first = *plan;
  if (two_runs) internal::join_levels(first, std::vector<double>(plan->asked.size(), 1.0));
  auto judged_run = internal::first_run(first, markers, filter, options, progress);
  if (!judged_run) return std::unexpected(judged_run.error());
  if (two_runs)
    if (auto status = run_levels(*plan, markers, filter, options, progress, *judged_run); !status)
      return std::unexpected(status.error());

  auto& run = judged_run->body;
  auto& result = run.result;
  if (options.judge_samples)
    internal::add_sample_findings(run.plan.problem, judged_run->judged, markers, result.motion, result.fit);
  if (options.error_bars) {
    const data::Trajectories& kept = judged_run->kept(markers);
    forget_rejected(run.plan, kept, run.track);
    internal::add_error_bars(run.plan, kept, run.track, filter, options, result);
    if (options.feed_forward) warn_of_step(judged_run->goals(markers, options), filter, options, run);
  }
  internal::count_directions(run.plan, run.track, result.levels);
  add_level_findings(result);
  if (plan->asked.size() > 1 && options.strict) warn_of_relaxing(result);
  internal::add_marker_errors(result.motion, result.fit);
  if (result.flagged_frames > 0)
    result.fit.findings.push_back(
        {.kind = data::FindingKind::flagged,
         .size = static_cast<double>(result.flagged_frames),
         .detail =
             fmt::format("the goals were out of reach, or the body ran away and was started anew ({} times)",
                         result.restarts)});
  return std::move(result);
}

/// Levels from the poses of a body that follows all markers alike.
Result<LevelProposal> propose(const model::Model& model, const data::Trajectories& markers,
                              const TrackOptions& options, const Progress& progress) {
  TrackOptions alike = options;
  alike.propose_levels = alike.strict = false;
  alike.accuracy_rad = 0.0;
  auto plan = internal::make_plan(model, markers, alike);
  if (!plan) return std::unexpected(plan.error());
  if (plan->problem.frames < 2)
    return fail(Code::bad_input, "the time range holds one frame; direct marker control needs two at least");
  const auto run =
      internal::first_run(*plan, markers, internal::make_filter(plan->rate_hz, alike), alike, progress);
  if (!run) return std::unexpected(run.error());
  return internal::propose_levels(run->body.plan, run->body.track);
}

Result<AccuracyChoice> choose(const model::Model& model, const data::Trajectories& markers,
                              const TrackOptions& options, const Progress& progress) {
  const auto plan = internal::make_plan(model, markers, options);
  if (!plan) return std::unexpected(plan.error());
  if (plan->problem.frames < 2)
    return fail(Code::bad_input, "the time range holds one frame; direct marker control needs two at least");
  const auto asked = internal::pilot_options(plan->rate_hz, options);
  auto pilot = internal::make_plan(model, markers, asked);
  if (!pilot) return std::unexpected(pilot.error());
  if (pilot->asked.size() > 1) internal::join_levels(*pilot, std::vector<double>(pilot->asked.size(), 1.0));
  const GoalFilter filter = internal::make_filter(plan->rate_hz, asked);
  const auto run = internal::first_run(*pilot, markers, filter, asked, progress);
  if (!run) return std::unexpected(run.error());
  Plan as_followed = *plan;
  as_followed.locked = run->body.plan.locked;
  as_followed.problem.fixed_speed = run->body.plan.problem.fixed_speed;
  return internal::choose_by_accuracy(as_followed, *run, markers, filter, options);
}

}  // namespace

Result<TrackResult> track_markers(const model::Model& model, const data::Trajectories& markers,
                                  const TrackOptions& options, const Progress& progress) {
  if (options.propose_levels) {
    if (auto status = options.check(); !status) return std::unexpected(status.error());
    auto proposed = propose(model, markers, options, progress);
    if (!proposed) return std::unexpected(proposed.error());
    TrackOptions with = options;
    with.propose_levels = false;
    with.levels = proposed->levels;
    auto result = track_markers(model, markers, with, progress);
    if (result) result->proposed = std::move(*proposed);
    return result;
  }
  if (!(options.accuracy_rad > 0.0)) return track_as_given(model, markers, options, progress);
  auto chosen = choose(model, markers, options, progress);
  if (!chosen) return std::unexpected(chosen.error());
  TrackOptions tuned = options;
  tuned.accuracy_rad = 0.0;
  tuned.cutoff_hz = chosen->cutoff_hz;
  tuned.step_s = chosen->step_s;
  tuned.omega_rad_s = chosen->omega_rad_s;
  auto result = track_as_given(model, markers, tuned, progress);
  if (result) result->accuracy = std::move(*chosen);
  return result;
}

Result<data::Trajectories> control_goals(const data::Trajectories& markers, const TrackOptions& options) {
  if (auto status = options.check(); !status) return std::unexpected(status.error());
  if (auto status = markers.validate(); !status) return std::unexpected(status.error());
  const GoalFilter filter = internal::make_filter(markers.time.rate_hz, options);
  const int M = static_cast<int>(markers.markers());
  const auto F = markers.frames();
  auto goals = data::Trajectories::all_missing(markers.names, markers.time);
  if (F < 2) return goals;
  internal::SampleWindow samples(M, F);
  Eigen::Matrix3Xd y(3, M);
  Eigen::VectorXd weight(M);
  for (std::int64_t f = 0; f < F; ++f) {
    for (int m = 0; m < M; ++m) {
      weight[m] = markers.present(f, m) ? 1.0 : 0.0;
      if (weight[m] > 0.0) y.col(m) = markers.x(f, m);
    }
    samples.push(y, weight);
  }
  samples.end();
  internal::GoalCell cell(M);
  internal::GoalValues goal(M);
  for (std::int64_t f = 0; f < F; ++f) {
    const std::int64_t first = std::min(f, F - 2);
    filter.build(samples, first, cell);
    cell.at(static_cast<double>(f - first), goal);
    for (int m = 0; m < M; ++m) {
      if (goal.weight[m] <= 0.0) continue;
      goals.x(f, m) = goal.x.col(m);
      goals.state[goals.index(f, m)] = data::SampleState::measured;
    }
  }
  return goals;
}

}  // namespace kinemark::motion
