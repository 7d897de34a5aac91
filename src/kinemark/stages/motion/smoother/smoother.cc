// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/smoother.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/data/motion_coordinates.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/marker_account.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/smoother/coordinate_smoother.h"
#include "kinemark/stages/motion/smoother/internal/motion_output.h"
#include "kinemark/stages/motion/smoother/internal/noise.h"
#include "kinemark/stages/motion/smoother/internal/run.h"
#include "kinemark/stages/motion/smoother/internal/slow_errors.h"
#include "kinemark/stages/motion/smoother/internal/start.h"
#include "kinemark/stages/motion/smoother/internal/step_modes.h"
#include "kinemark/stages/motion/smoother/internal/whole_trajectory.h"

namespace kinemark::motion {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using internal::Problem;

constexpr double kLargestStateSd = 0.5;  // rad or m; beyond it a linear error bar is not valid

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Measured minus model, what it amounts to marker by marker, and the gaps of closed loops.
void fill_marker_errors(const Problem& problem, const data::Trajectories& markers, const MatrixXd& states,
                        SmootherResult& result) {
  const auto M = static_cast<std::int64_t>(problem.data_marker.size());
  auto& motion = result.motion;
  motion.marker_error.assign(at(3 * M * problem.frames), kNaN);
  model::Workspace w(problem.model);
  VectorXd gap;
  result.fit.max_loop_gap_m = 0.0;
  for (std::int64_t f = 0; f < problem.frames; ++f) {
    model::kinematics(problem.model, w, states.col(f));
    model::point_constraint_gaps(problem.model, w, gap);
    if (gap.size() > 0)
      result.fit.max_loop_gap_m = std::max(result.fit.max_loop_gap_m, gap.cwiseAbs().maxCoeff());
    for (std::int64_t m = 0; m < M; ++m) {
      if (!markers.present(problem.first_frame + f, problem.data_marker[at(m)])) continue;
      const Vector3d error = markers.x(problem.first_frame + f, problem.data_marker[at(m)]) - w.marker.col(m);
      std::copy_n(error.data(), 3, motion.marker_error.data() + 3 * (f * M + m));
    }
  }
  internal::add_marker_errors(motion, result.fit);
}

/// q_sd, determined, the covariances and the frames' status.
void fill_bars(const Problem& problem, const Observations& observations, const internal::NoiseSplit& noise,
               const MatrixXd& states, const internal::StepModes& steps, int threads,
               internal::WholeTrajectory& trajectory, SmootherResult& result) {
  const auto& model = problem.model;
  auto& motion = result.motion;
  const std::int64_t F = motion.frames(), n = motion.size();
  const internal::SlowErrors slow(model, observations, noise, problem.fixed_speed, motion, states,
                                  steps.precision, threads);
  motion.q_sd.assign(at(F * n), kNaN);
  motion.determined.assign(at(F * n), 0);
  result.errors.covariance.assign(at(6 * F * n), kNaN);
  model::Workspace w(model);
  VectorXd q(n);
  MatrixXd E, covariance;
  const auto coordinates = model.coordinates();
  const auto do_frame = [&](std::int64_t f, int index, const MatrixXd& joint) {
    std::copy_n(motion.q.data() + motion.index(f, 0), n, q.data());
    model::kinematics(model, w, states.col(f));
    model::coordinate_jacobian(model, w, q, E);
    for (Eigen::Index i = 0; i < E.cols(); ++i)
      if (problem.fixed_speed[at(i)]) E.col(i).setZero();
    internal::coordinate_covariances(joint, index, motion.time.rate_hz, E, covariance);
    const VectorXd unsure = steps.variance(E, f);
    bool all = true;
    for (int c = 0; c < n; ++c) {
      const auto i = motion.index(f, c);
      const double sd = std::sqrt(std::max(0.0, covariance(0, c)) + unsure[c] + slow.variance(f, c));
      const bool good = sd <= kLargestStateSd;
      motion.determined[i] = good;
      if (good) motion.q_sd[i] = sd;
      all = all && good;
      if (coordinates[at(c)].source < 0)
        std::copy_n(covariance.col(c).data(), 6, result.errors.covariance.data() + 6 * i);
    }
    if (!all && motion.status[at(f)] == data::FrameStatus::converged)
      motion.status[at(f)] = data::FrameStatus::underdetermined;
  };
  trajectory.covariances(states, [&](std::int64_t first, const MatrixXd& joint) {
    if (first + 3 == F) do_frame(F - 1, 2, joint);
    do_frame(first + 1, 1, joint);
    if (first == 0) do_frame(0, 0, joint);
  });
}

/// The recording without the samples that least squares left out; none where it kept all.
std::optional<data::Trajectories> without_rejected(const Problem& problem, const data::Trajectories& markers,
                                                   const data::JointMotion& start) {
  std::optional<data::Trajectories> kept;
  const std::size_t M = problem.data_marker.size();
  for (std::size_t i = 0; i < start.marker_state.size(); ++i) {
    if (start.marker_state[i] != data::SampleState::rejected) continue;
    if (!kept) kept = markers;
    kept->set_missing(problem.first_frame + static_cast<std::int64_t>(i / M), problem.data_marker[i % M],
                      data::SampleState::rejected);
  }
  return kept;
}

SmootherResult begin_result(IkResult& start, const model::Model& model) {
  SmootherResult result;
  result.fit = std::move(start.fit);
  auto& motion = result.motion;
  motion.markers = start.motion.markers;
  motion.marker_state = start.motion.marker_state;
  motion.time = start.motion.time;
  data::set_coordinates(model.description(), motion);
  return result;
}

}  // namespace

namespace internal {

Result<Prepared> prepare(const model::Model& model, const data::Trajectories& markers,
                         const SmootherOptions& options, const Progress& progress) {
  if (auto status = options.check(); !status) return std::unexpected(status.error());
  const auto begun = std::chrono::steady_clock::now();
  IkOptions ik = options.ik;
  ik.error_bars = true;
  auto start = solve_ik(model, markers, ik, progress);
  if (!start) return std::unexpected(start.error());
  auto problem = make_problem(model, markers, ik);
  if (!problem) return std::unexpected(problem.error());
  if (problem->frames < kFewestSamples)
    return fail(Code::bad_input, fmt::format("the time range holds {} frames; the smoother needs {} or more",
                                             problem->frames, kFewestSamples));
  auto kept = without_rejected(*problem, markers, start->motion);
  if (ik.marker_noise_sd_m <= 0.0 && options.huber_sd > 0.0)
    internal::leave_out_outliers(*problem, kept ? *kept : markers, options.huber_sd, ik.threads, *start);
  return Prepared{.problem = std::move(*problem),
                  .start = std::move(*start),
                  .seconds = seconds_since(begun),
                  .kept = std::move(kept)};
}

Result<SmootherResult> run(Prepared& prepared, const data::Trajectories& markers,
                           const Observations& observations, const NoiseSplit& noise,
                           const SmootherOptions& options, const Progress& progress) {
  const auto solving = std::chrono::steady_clock::now();
  const Problem& problem = prepared.problem;
  MatrixXd states = bridged_states(problem.model, prepared.start.motion);
  for (std::int64_t f = 0; f < problem.frames; ++f) problem.prescribe(f, states.col(f));
  const auto steps = internal::step_modes(
      problem.model, observations, problem.fixed_speed, states,
      single_paths(problem.model, prepared.start.motion, states, noise.raised), noise.beyond_white);
  SmootherResult result = begin_result(prepared.start, problem.model);
  result.start_seconds = prepared.seconds;
  WholeTrajectory trajectory(problem.model, observations, problem.frames, steps.precision,
                             {.fixed = problem.fixed_speed, .lower = problem.lower, .upper = problem.upper});
  const auto outcome = trajectory.solve(states, options.max_iterations, progress);
  if (outcome.stopped) return fail(Code::cancelled, "the smoother was stopped");
  result.iterations = outcome.iterations;
  result.converged = outcome.converged;
  if (!outcome.converged)
    result.fit.findings.push_back({.kind = data::FindingKind::not_settled,
                                   .subject = "the smoother",
                                   .size = static_cast<double>(outcome.iterations)});
  fill_coordinates(problem.model, states, result.motion);
  for (const auto unsettled : outcome.unsettled)
    result.motion.status.push_back(unsettled ? data::FrameStatus::not_converged
                                             : data::FrameStatus::converged);
  if (options.error_bars)
    fill_bars(problem, observations, noise, states, steps, options.ik.threads, trajectory, result);
  fill_marker_errors(problem, markers, states, result);
  result.solve_seconds = seconds_since(solving);
  return result;
}

}  // namespace internal

Result<SmootherResult> smooth_motion(const model::Model& model, const data::Trajectories& markers,
                                     const SmootherOptions& options, const Progress& progress) {
  auto prepared = internal::prepare(model, markers, options, progress);
  if (!prepared) return std::unexpected(prepared.error());
  const auto& problem = prepared->problem;
  const auto noise =
      internal::split_noise(problem, prepared->start, options.ik.marker_noise_sd_m, options.huber_sd);
  const auto& believed = prepared->believed(markers);
  const MarkerObservations observations(believed, problem.data_marker, problem.first_frame, noise.trust);
  return internal::run(*prepared, believed, observations, noise, options, progress);
}

}  // namespace kinemark::motion
