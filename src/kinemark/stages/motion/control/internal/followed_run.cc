// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/followed_run.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/data/motion_coordinates.h"
#include "kinemark/stages/motion/control/internal/first_pose.h"
#include "kinemark/stages/motion/control/internal/walker.h"

namespace kinemark::motion::internal {
namespace {

/// Goals at the frames, so that the first pose, the noise and the caller see what the controller sees.
void fill_goals(const Plan& plan, const data::Trajectories& markers, const GoalFilter& filter,
                const SampleWindow& samples, const data::Derivatives* derivatives, Track& track) {
  const auto& p = plan.problem;
  const int M = p.model.marker_count();
  GoalCell cell(M);
  GoalValues goal(M);
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
Status check_seen(const Plan& plan, const SampleWindow& samples, const Track& track, const TimeBase& time) {
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

/// Follow all samples as they are, and judge them by the body that did. False: not all are explained, and the
/// run does not count.
Result<bool> follow_all(const data::Trajectories& markers, const GoalFilter& filter,
                        const TrackOptions& options, const Progress& progress, FollowedRun& run) {
  if (auto status = follow(markers, {.kept = markers, .goals = markers}, filter, options, progress, run);
      !status)
    return std::unexpected(status.error());
  if (!options.judge_samples) return true;
  const auto found = judge_followed(run.plan.problem, run.plan.start_options, markers, run.track.states,
                                    run.result.motion.status);
  run.result.solves += found.solves;
  return found.all_explained;
}

/// Follow what is left of the samples when each was judged by the poses that fit its frame best.
Status follow_judged(const data::Trajectories& markers, const GoalFilter& filter, const TrackOptions& options,
                     const Progress& progress, JudgedRun& run) {
  auto& body = run.body;
  auto found = solve_and_judge(body.plan.problem, body.plan.start_options, markers, progress);
  if (!found) return stopped();
  run.judged = std::move(*found);
  if (auto status = follow(markers, {.kept = run.kept(markers), .goals = run.goals(markers, options)}, filter,
                           options, progress, body);
      !status)
    return status;
  body.result.solves += body.plan.problem.frames;
  return {};
}

}  // namespace

std::unexpected<Error> stopped() { return fail(Code::cancelled, "direct marker control was stopped"); }

void fill_window(const Plan& plan, const data::Trajectories& markers, SampleWindow& samples) {
  const int M = plan.problem.model.marker_count();
  Eigen::Matrix3Xd y(3, M);
  Eigen::VectorXd weight(M);
  for (std::int64_t f = 0; f < plan.problem.frames; ++f) {
    plan.problem.observe(markers, f, y, weight);
    samples.push(y, weight);
  }
  samples.end();
}

Status follow(const data::Trajectories& markers, const Followed& followed, const GoalFilter& filter,
              const TrackOptions& options, const Progress& progress, FollowedRun& run) {
  auto& plan = run.plan;
  {
    SampleWindow samples(plan.problem.model.marker_count(), plan.problem.frames);
    fill_window(plan, followed.goals, samples);
    fill_goals(plan, followed.goals, filter, samples, options.derivatives, run.track);
    if (auto status = check_seen(plan, samples, run.track, markers.time); !status) return status;
  }
  const Eigen::VectorXd start = find_first_pose(plan, run.track.goals, options.lock);
  if (auto status = check_mass(plan, start); !status) return status;
  describe(plan, markers, run.result);
  Walker walker(plan, filter, plan.problem.frames, run.result.motion.time.t0_s);
  if (options.derivatives != nullptr) walker.use_derivatives(*options.derivatives, markers.markers());
  fill_window(plan, followed.goals, walker.samples());
  Recorder recorder(plan, followed.kept, walker, run.track, run.result);
  const auto begin = std::chrono::steady_clock::now();
  if (!recorder.run(start, progress)) return stopped();
  run.result.solve_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return {};
}

Result<JudgedRun> first_run(const Plan& plan, const data::Trajectories& markers, const GoalFilter& filter,
                            const TrackOptions& options, const Progress& progress) {
  JudgedRun run{.body = {.plan = plan, .track = {}, .result = {}}, .judged = {}};
  if (!options.judge_samples || !plan.settle) {
    const auto explained = follow_all(markers, filter, options, progress, run.body);
    if (!explained) return std::unexpected(explained.error());
    if (*explained) return run;
  }
  run.body = {.plan = plan, .track = {}, .result = {}};
  if (auto status = follow_judged(markers, filter, options, progress, run); !status)
    return std::unexpected(status.error());
  return run;
}

}  // namespace kinemark::motion::internal
