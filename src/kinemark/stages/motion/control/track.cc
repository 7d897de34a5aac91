// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/track.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <expected>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/data/motion_coordinates.h"
#include "kinemark/stages/motion/control/internal/first_pose.h"
#include "kinemark/stages/motion/control/internal/recorder.h"
#include "kinemark/stages/motion/control/internal/step_error.h"
#include "kinemark/stages/motion/control/internal/track_bars.h"
#include "kinemark/stages/motion/internal/judged_frames.h"
#include "kinemark/stages/motion/internal/marker_account.h"
#include "kinemark/stages/motion/internal/sample_findings.h"

namespace kinemark::motion {
namespace {

using internal::GoalFilter;
using internal::Plan;
using internal::Track;
using internal::Walker;

void fill_window(const Plan& plan, const data::Trajectories& markers, internal::SampleWindow& samples) {
  const int M = plan.problem.model.marker_count();
  Eigen::Matrix3Xd y(3, M);
  Eigen::VectorXd weight(M);
  for (std::int64_t f = 0; f < plan.problem.frames; ++f) {
    plan.problem.observe(markers, f, y, weight);
    samples.push(y, weight);
  }
  samples.end();
}

/// Goals at the frames, so that the first pose, the noise and the caller see what the controller sees.
void fill_goals(const Plan& plan, const data::Trajectories& markers, const GoalFilter& filter,
                const internal::SampleWindow& samples, const data::Derivatives* derivatives, Track& track) {
  const auto& p = plan.problem;
  const int M = p.model.marker_count();
  internal::GoalCell cell(M);
  internal::GoalValues goal(M);
  track.goals = data::Trajectories::all_missing(markers.names, markers.time);
  track.weights.setZero(M, p.frames);
  for (std::int64_t f = 0; f < p.frames; ++f) {
    const std::int64_t first = std::min(f, std::max<std::int64_t>(0, p.frames - 2));
    if (derivatives != nullptr)
      filter.build(samples, first, *derivatives, p.data_marker, markers.markers(), p.first_frame, cell);
    else
      filter.build(samples, first, cell);
    cell.at(static_cast<double>(f - first), goal);
    track.weights.col(f) = goal.weight;
    for (int m = 0; m < M; ++m) {
      if (goal.weight[m] <= 0.0) continue;
      track.goals.x(p.first_frame + f, p.data_marker[at(m)]) = goal.x.col(m);
      track.goals.state[track.goals.index(p.first_frame + f, p.data_marker[at(m)])] =
          data::SampleState::measured;
    }
  }
}

void describe(const Plan& plan, const data::Trajectories& markers, TrackResult& result) {
  const auto& p = plan.problem;
  result.fit = p.fit;
  result.step_s = plan.step_s;
  result.free_speeds =
      static_cast<int>(std::count(p.fixed_speed.begin(), p.fixed_speed.end(), std::uint8_t{0}));
  auto& motion = result.motion;
  data::set_coordinates(p.model.description(), motion);
  for (const auto& marker : p.model.description().markers) motion.markers.push_back(marker.name);
  motion.time = {.rate_hz = markers.time.rate_hz,
                 .t0_s = markers.time.time_s(p.first_frame),
                 .frames = p.frames,
                 .first_number = markers.time.number(p.first_frame)};
  for (const int c : plan.locked) result.locked_coordinates.push_back(motion.coordinates[at(c)]);
}

/// Without goals of other kinds there is nothing to do where no marker is seen.
Status check_seen(const Plan& plan, const internal::SampleWindow& samples, const Track& track,
                  const TimeBase& time) {
  const auto& p = plan.problem;
  if (track.weights.size() > 0 && track.weights.maxCoeff() > 0.0) return {};
  if (std::any_of(plan.levels.begin(), plan.levels.end(),
                  [](const auto& level) { return !level.tasks.empty(); }))
    return {};
  bool seen = false;
  for (std::int64_t f = 0; f < p.frames && !seen; ++f)
    for (int m = 0; m < p.model.marker_count() && !seen; ++m) seen = samples.present(f, m);
  return fail(Code::bad_input,
              fmt::format("no tracked marker is seen {}between {:g} and {:g} s",
                          seen ? "in enough frames in a row to be followed " : "", time.time_s(p.first_frame),
                          time.time_s(p.first_frame + p.frames - 1)));
}

Status check_derivatives(const data::Trajectories& markers, const TrackOptions& options) {
  if (options.derivatives == nullptr) return {};
  if (auto status = options.derivatives->validate(markers); !status) return status;
  if (options.derivatives->velocity.empty() || options.derivatives->acceleration.empty())
    return fail(Code::bad_input, "the derivatives given lack velocity or acceleration; need both");
  return {};
}

std::unexpected<Error> stopped() { return fail(Code::cancelled, "direct marker control was stopped"); }

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

void warn_of_step(const model::Model& model, const Plan& plan, TrackResult& result) {
  auto warning = internal::warn_of_step(model, result.motion, plan.step_s, std::sqrt(plan.kp));
  if (!warning.empty()) result.fit.warnings.push_back(std::move(warning));
}

/// Samples as they are followed.
struct Followed {
  const data::Trajectories& kept;   ///< of what the deviations are
  const data::Trajectories& goals;  ///< the same, and in place of what was left out where the body has it
};

/// A body that has followed a recording.
struct FollowedRun {
  Plan plan;
  Track track;
  TrackResult result;
};

Status follow(const data::Trajectories& markers, const Followed& followed, const GoalFilter& filter,
              const TrackOptions& options, const Progress& progress, FollowedRun& run) {
  auto& plan = run.plan;
  {
    internal::SampleWindow samples(plan.problem.model.marker_count(), plan.problem.frames);
    fill_window(plan, followed.goals, samples);
    fill_goals(plan, followed.goals, filter, samples, options.derivatives, run.track);
    if (auto status = check_seen(plan, samples, run.track, markers.time); !status) return status;
  }
  const Eigen::VectorXd start = internal::find_first_pose(plan, run.track.goals, options.lock);
  if (auto status = internal::check_mass(plan, start); !status) return status;
  describe(plan, markers, run.result);
  Walker walker(plan, filter, plan.problem.frames, run.result.motion.time.t0_s);
  if (options.derivatives != nullptr) walker.use_derivatives(*options.derivatives, markers.markers());
  fill_window(plan, followed.goals, walker.samples());
  internal::Recorder recorder(plan, followed.kept, walker, run.track, run.result);
  const auto begin = std::chrono::steady_clock::now();
  if (!recorder.run(start, progress)) return stopped();
  run.result.solve_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return {};
}

/// Follow all samples as they are, and judge them by the body that did. False: not all are explained, and the
/// run does not count.
Result<bool> follow_all(const data::Trajectories& markers, const GoalFilter& filter,
                        const TrackOptions& options, const Progress& progress, FollowedRun& run) {
  if (auto status = follow(markers, {.kept = markers, .goals = markers}, filter, options, progress, run);
      !status)
    return std::unexpected(status.error());
  if (!options.judge_samples) return true;
  const auto found = internal::judge_followed(run.plan.problem, run.plan.start_options, markers,
                                              run.track.states, run.result.motion.status);
  run.result.solves += found.solves;
  return found.all_explained;
}

/// Follow what is left of the samples when each was judged by the poses that fit its frame best.
Status follow_judged(const data::Trajectories& markers, const GoalFilter& filter, const TrackOptions& options,
                     const Progress& progress, FollowedRun& run, internal::JudgedFrames& judged) {
  auto found = internal::solve_and_judge(run.plan.problem, run.plan.start_options, markers, progress);
  if (!found) return stopped();
  judged = std::move(*found);
  const data::Trajectories& kept = judged.kept ? *judged.kept : markers;
  // What was left out is followed where its marker lies on the body in the frames beside, lest the goals
  // jump.
  const data::Trajectories& goals = judged.filled && options.derivatives == nullptr ? *judged.filled : kept;
  if (auto status = follow(markers, {.kept = kept, .goals = goals}, filter, options, progress, run); !status)
    return status;
  run.result.solves += run.plan.problem.frames;
  return {};
}

}  // namespace

Result<TrackResult> track_markers(const model::Model& model, const data::Trajectories& markers,
                                  const TrackOptions& options, const Progress& progress) {
  auto plan = internal::make_plan(model, markers, options);
  if (!plan) return std::unexpected(plan.error());
  if (auto status = check_derivatives(markers, options); !status) return std::unexpected(status.error());
  if (plan->problem.frames < 2)
    return fail(Code::bad_input, "the time range holds one frame; direct marker control needs two at least");

  const GoalFilter filter = internal::make_filter(plan->rate_hz, options);
  const bool judges_first = options.judge_samples && plan->settle;
  FollowedRun run{.plan = *plan, .track = {}, .result = {}};
  internal::JudgedFrames judged;
  bool done = false;
  if (!judges_first) {
    const auto explained = follow_all(markers, filter, options, progress, run);
    if (!explained) return std::unexpected(explained.error());
    done = *explained;
  }
  if (!done) {
    run = {.plan = *plan, .track = {}, .result = {}};
    if (auto status = follow_judged(markers, filter, options, progress, run, judged); !status)
      return std::unexpected(status.error());
  }

  auto& result = run.result;
  if (options.judge_samples)
    internal::add_sample_findings(run.plan.problem, judged, markers, result.motion, result.fit);
  if (options.error_bars) {
    const data::Trajectories& kept = judged.kept ? *judged.kept : markers;
    forget_rejected(run.plan, kept, run.track);
    internal::add_error_bars(run.plan, kept, run.track, filter, options, result);
    if (options.feed_forward) warn_of_step(model, run.plan, result);
  }
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
