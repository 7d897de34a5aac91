// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/ik.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/data/motion_coordinates.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/error_bars.h"
#include "kinemark/stages/motion/internal/frame_solver.h"
#include "kinemark/stages/motion/internal/judged_frames.h"
#include "kinemark/stages/motion/internal/loose_bodies.h"
#include "kinemark/stages/motion/internal/marker_account.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/internal/rival_poses.h"
#include "kinemark/stages/motion/internal/sample_findings.h"
#include "kinemark/stages/motion/internal/solved_motion.h"
#include "kinemark/stages/motion/internal/start.h"

namespace kinemark::motion {
namespace {

using data::FrameStatus;
using internal::FrameSolver;
using internal::Problem;

/// What the frames add up to.
void take_frames(internal::SolvedFrames& solved, IkResult& result) {
  result.motion.marker_error = std::move(solved.marker_error);
  result.motion.status = std::move(solved.status);
  result.iterations = solved.iterations;
  for (const double cost : solved.cost) result.cost += cost;
  for (const double gap : solved.loop_gap_m)
    result.fit.max_loop_gap_m = std::max(result.fit.max_loop_gap_m, gap);
}

void add_task_costs(const Problem& problem, IkResult& result) {
  for (const auto& task : problem.coordinate_tasks)
    for (std::int64_t f = 0; f < problem.frames; ++f) {
      const double miss = task.target(f) - result.motion.q[result.motion.index(f, task.coordinate)];
      if (result.motion.status[at(f)] != FrameStatus::no_markers) result.cost += task.weight * miss * miss;
    }
}

/// As given, or estimated from the residuals.
MarkerVariances find_variances(const Problem& problem, const IkOptions& options,
                               const data::Trajectories& markers, const Eigen::MatrixXd& states) {
  if (!(options.marker_noise_sd_m > 0.0))
    return estimate_variances(problem, markers, states, options.threads);
  MarkerVariances variances;
  variances.own.setConstant(problem.model.marker_count(),
                            options.marker_noise_sd_m * options.marker_noise_sd_m);
  variances.common.setZero(static_cast<Eigen::Index>(problem.model.bodies().size()));
  return variances;
}

}  // namespace

Result<IkResult> solve_ik(const model::Model& model, const data::Trajectories& markers,
                          const IkOptions& options, const Progress& progress) {
  auto problem = internal::make_problem(model, markers, options);
  if (!problem) return std::unexpected(problem.error());
  IkResult result;
  result.fit = problem->fit;
  for (const auto& coordinate : problem->prescribed)
    result.fit.warnings.push_back(fmt::format(
        "coordinate '{}' follows the function of time that the model prescribes; no marker moves it",
        coordinate.name));
  result.fit.max_loop_gap_m = 0.0;
  auto& motion = result.motion;
  data::set_coordinates(model.description(), motion);
  for (const auto& marker : problem->model.description().markers) motion.markers.push_back(marker.name);
  motion.time = {.rate_hz = markers.time.rate_hz,
                 .t0_s = markers.time.time_s(problem->first_frame),
                 .frames = problem->frames,
                 .first_number = markers.time.number(problem->first_frame)};

  const auto start = std::chrono::steady_clock::now();
  auto judged = internal::solve_and_judge(*problem, options, markers, progress);
  if (!judged) return fail(Code::cancelled, "inverse kinematics was stopped");
  auto& solved = judged->solved;
  const data::Trajectories& kept = judged->kept ? *judged->kept : markers;
  const auto loose = internal::find_loose_frames(*problem, kept);
  MarkerVariances variances;
  std::vector<internal::RivalPose> rivals;
  if (loose.any()) {
    variances = find_variances(*problem, options, kept, solved.states);
    internal::FrameWalk walk(*problem, options, progress);
    std::vector<std::uint8_t> changed;
    rivals = internal::choose_among_rivals(*problem, options, kept, loose, variances, walk, solved, changed);
    if (std::ranges::count(changed, std::uint8_t{1}) > 0)
      variances = find_variances(*problem, options, kept, solved.states);
  }
  result.solve_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (options.error_bars && !loose.any()) variances = find_variances(*problem, options, kept, solved.states);
  take_frames(solved, result);
  internal::fill_coordinates(*problem, solved.states, motion);
  add_task_costs(*problem, result);
  internal::note_limits(*problem, motion, result.fit);
  internal::add_sample_findings(*problem, *judged, markers, motion, result.fit);

  if (options.error_bars) {
    compute_error_bars(*problem, kept, solved.states, variances, options.threads, motion);
    internal::doubt_rivals(*problem, rivals, motion);
    internal::flag_underdetermined(motion);
    internal::add_marker_noise(problem->model, variances, result.fit);
  }
  internal::add_marker_errors(motion, result.fit);
  return result;
}

Result<CommonOffset> find_common_offset(const model::Model& model, const data::Trajectories& markers,
                                        const IkOptions& options) {
  auto problem = internal::make_problem(model, markers, options);
  if (!problem) return std::unexpected(problem.error());
  FrameSolver solver(*problem, options);
  Eigen::Matrix3Xd y(3, problem->model.marker_count());
  Eigen::VectorXd weight(problem->model.marker_count());
  const std::int64_t stride = (problem->frames + 9) / 10;
  CommonOffset offset;
  // Alternate: pose for the shifted markers, then shift by the mean of what is left. Linear, but each round
  // is cheap.
  for (int round = 0; round < 200; ++round) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double squares = 0.0;
    std::int64_t count = 0;
    Eigen::VectorXd x = problem->model.default_state();
    for (std::int64_t f = 0; f < problem->frames; f += stride) {
      problem->observe(markers, f, y, weight);
      if (weight.sum() == 0.0) continue;
      y.colwise() += offset.shift_m;
      if (f == 0)
        find_start(*problem, options, solver, y, weight, f, options.starts, x);
      else
        solver.solve(y, weight, f, x);
      for (Eigen::Index m = 0; m < weight.size(); ++m) {
        if (weight[m] == 0.0) continue;
        mean += solver.residual().col(m);
        squares += solver.residual().col(m).squaredNorm();
        ++count;
      }
    }
    if (count == 0) break;
    mean /= static_cast<double>(count);
    offset.rms_after_m = std::sqrt(squares / static_cast<double>(count));
    if (round == 0) offset.rms_before_m = offset.rms_after_m;
    if (mean.norm() < 1e-6) break;
    offset.shift_m -= mean;
  }
  return offset;
}

Result<double> calc_ik_cost(const model::Model& model, const data::Trajectories& markers,
                            const IkOptions& options, const Eigen::MatrixXd& q) {
  auto problem = internal::make_problem(model, markers, options);
  if (!problem) return std::unexpected(problem.error());
  if (q.rows() != problem->frames || q.cols() != model.coordinate_count())
    return fail(Code::bad_input,
                fmt::format("coordinates have {} rows and {} columns; need {} frames and {} coordinates",
                            q.rows(), q.cols(), problem->frames, model.coordinate_count()));
  FrameSolver solver(*problem, options);
  Eigen::Matrix3Xd y(3, problem->model.marker_count());
  Eigen::VectorXd weight(problem->model.marker_count());
  double cost = 0.0;
  for (std::int64_t f = 0; f < problem->frames; ++f) {
    problem->observe(markers, f, y, weight);
    cost +=
        solver.square_cost(y, weight, f, model::state_from_coordinates(problem->model, q.row(f).transpose()));
  }
  return cost;
}

}  // namespace kinemark::motion
