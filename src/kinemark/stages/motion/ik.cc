// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/ik.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/error_bars.h"
#include "kinemark/stages/motion/internal/frame_solver.h"
#include "kinemark/stages/motion/internal/marker_account.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/internal/start.h"

namespace kinemark::motion {
namespace {

using data::FrameStatus;
using internal::FrameSolver;
using internal::Problem;

constexpr int kRetryStarts = 6;  // poses tried on a frame whose cost jumps

/// Walks over the frames from the anchor, forwards and then backwards, and fills states and errors.
class Tracker {
 public:
  Tracker(const Problem& problem, const IkOptions& options, const data::Trajectories& markers,
          const Progress& progress, IkResult& result)
      : problem_(problem),
        options_(options),
        markers_(markers),
        progress_(progress),
        result_(result),
        solver_(problem, options),
        y_(3, problem.model.marker_count()),
        weight_(problem.model.marker_count()) {
    states_.resize(problem.model.state_count(), problem.frames);
    result_.motion.marker_error.assign(at(3 * problem.frames) * at(problem.model.marker_count()),
                                       std::numeric_limits<double>::quiet_NaN());
    result_.motion.status.assign(at(problem.frames), FrameStatus::no_markers);
    x_ = before_ = problem.model.default_state();
    retry_ = x_;
    move_.setZero(problem.model.speed_count());
  }

  /// False when the caller stopped it.
  bool run() {
    const std::int64_t anchor = find_anchor();
    problem_.observe(markers_, anchor, y_, weight_);
    // The recording may begin anywhere relative to the default pose: several starts, the cheapest wins.
    find_start(problem_, options_, solver_, y_, weight_, anchor, options_.starts, x_);
    const Eigen::VectorXd start = x_;
    if (!walk(anchor, problem_.frames, 1)) return false;
    x_ = start;
    if (!walk(anchor - 1, -1, -1)) return false;
    result_.iterations = solver_.iterations();
    return true;
  }

  [[nodiscard]] const Eigen::MatrixXd& states() const { return states_; }

 private:
  /// First frame in which at least 95 % as many markers are seen as in the best frame.
  std::int64_t find_anchor() const {
    std::vector<int> seen(at(problem_.frames), 0);
    for (std::int64_t f = 0; f < problem_.frames; ++f)
      for (const int m : problem_.data_marker) seen[at(f)] += markers_.present(problem_.first_frame + f, m);
    const int best = *std::max_element(seen.begin(), seen.end());
    return std::find_if(seen.begin(), seen.end(), [&](int n) { return 20 * n >= 19 * best; }) - seen.begin();
  }

  bool walk(std::int64_t first, std::int64_t end, int direction) {
    int steady = 0;  // frames in a row with all markers: then the pose is extrapolated
    double usual_cost = -1.0;
    for (std::int64_t f = first; f != end; f += direction) {
      ++done_;
      if (progress_ && done_ % 1000 == 0 && !progress_(done_, problem_.frames)) return false;
      problem_.observe(markers_, f, y_, weight_);
      const auto visible = (weight_.array() > 0.0).count();
      if (visible == 0) {
        states_.col(f) = x_;
        steady = 0;
        continue;
      }
      const bool all = visible == weight_.size();
      const Eigen::VectorXd& last = x_;
      if (all && steady >= 2) {
        model::difference(problem_.model, before_, last, move_);
        before_ = last;
        model::integrate(problem_.model, x_, move_);
      } else {
        before_ = last;
      }
      steady = all ? steady + 1 : 0;
      auto outcome = solver_.solve(y_, weight_, f, x_);
      // A jump in cost may be a lost pose: try again from the neighbour laid over the markers, keep the
      // better.
      if (!outcome.converged || (usual_cost >= 0.0 && outcome.cost > 9.0 * usual_cost + 1e-4)) {
        retry_ = before_;
        const auto second = find_start(problem_, options_, solver_, y_, weight_, f,
                                       std::min(options_.starts, kRetryStarts), retry_);
        if (second.cost < 0.98 * outcome.cost) {
          x_ = retry_;
          outcome = second;
        }
        steady = 0;
        solver_.square_cost(y_, weight_, f, x_);  // residuals of the pose that was kept
      }
      usual_cost = usual_cost < 0.0 ? outcome.cost : 0.95 * usual_cost + 0.05 * outcome.cost;
      store(f, outcome.converged);
    }
    return true;
  }

  void store(std::int64_t f, bool converged) {
    states_.col(f) = x_;
    const auto M = weight_.size();
    for (Eigen::Index m = 0; m < M; ++m)
      if (weight_[m] > 0.0)
        for (int axis = 0; axis < 3; ++axis)
          result_.motion.marker_error[at((f * M + m) * 3 + axis)] = solver_.residual()(axis, m);
    result_.motion.status[at(f)] = converged ? FrameStatus::converged : FrameStatus::not_converged;
    result_.fit.max_loop_gap_m = std::max(result_.fit.max_loop_gap_m, solver_.loop_gap());
    double sum = 0.0;
    for (Eigen::Index m = 0; m < M; ++m) sum += weight_[m] * solver_.residual().col(m).squaredNorm();
    sum /= weight_.sum();
    result_.cost += sum;
  }

  const Problem& problem_;
  const IkOptions& options_;
  const data::Trajectories& markers_;
  const Progress& progress_;
  IkResult& result_;
  FrameSolver solver_;
  Eigen::Matrix3Xd y_;
  Eigen::VectorXd weight_, x_, before_, retry_, move_;
  Eigen::MatrixXd states_;
  std::int64_t done_ = 0;
};

/// Coordinates of all states, Euler angles continuous from frame to frame.
void fill_coordinates(const Problem& problem, const Eigen::MatrixXd& states, data::JointMotion& motion) {
  const int n = problem.model.coordinate_count();
  Eigen::VectorXd near(n), q(n);
  for (int c = 0; c < n; ++c) near[c] = problem.model.description().coordinates[at(c)].default_value;
  motion.q.resize(at(problem.frames * n));
  for (std::int64_t f = 0; f < problem.frames; ++f) {
    model::coordinates_from_state(problem.model, states.col(f), near, q);
    std::copy(q.data(), q.data() + n, motion.q.data() + motion.index(f, 0));
    near = q;
  }
}

void add_pull_costs(const Problem& problem, IkResult& result) {
  for (const auto& pull : problem.pulls)
    for (std::int64_t f = 0; f < problem.frames; ++f) {
      const double miss = pull.target(f) - result.motion.q[result.motion.index(f, pull.coordinate)];
      if (result.motion.status[at(f)] != FrameStatus::no_markers) result.cost += pull.weight * miss * miss;
    }
}

/// A coordinate that leans on its limit most of the time says that model and subject disagree.
void note_limits(const Problem& problem, IkResult& result) {
  const auto coordinates = problem.model.coordinates();
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    const int speed = coordinates[c].speed_idx;
    if (speed < 0 || problem.fixed_speed[at(speed)]) continue;
    std::int64_t leaning = 0;
    for (std::int64_t f = 0; f < problem.frames; ++f) {
      const double q = result.motion.q[result.motion.index(f, static_cast<std::int64_t>(c))];
      leaning += q <= problem.lower[speed] + 1e-9 || q >= problem.upper[speed] - 1e-9;
    }
    if (10 * leaning > problem.frames)
      result.fit.findings.push_back(
          {.kind = data::FindingKind::at_limit,
           .subject = result.motion.coordinates[c],
           .size = static_cast<double>(leaning) / static_cast<double>(problem.frames)});
  }
}

void flag_underdetermined(data::JointMotion& motion) {
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const auto* row = motion.determined.data() + motion.index(f, 0);
    if (motion.status[at(f)] == FrameStatus::converged &&
        std::any_of(row, row + motion.size(), [](auto d) { return d == 0; }))
      motion.status[at(f)] = FrameStatus::underdetermined;
  }
}

}  // namespace

Result<IkResult> solve_ik(const model::Model& model, const data::Trajectories& markers,
                          const IkOptions& options, const Progress& progress) {
  auto problem = internal::make_problem(model, markers, options);
  if (!problem) return std::unexpected(problem.error());
  IkResult result;
  result.fit = problem->fit;
  result.fit.max_loop_gap_m = 0.0;
  auto& motion = result.motion;
  for (const auto& coordinate : model.description().coordinates) {
    motion.coordinates.push_back(coordinate.name);
    motion.is_rotation.push_back(coordinate.is_rotation);
  }
  for (const auto& marker : problem->model.description().markers) motion.markers.push_back(marker.name);
  motion.time = {.rate_hz = markers.time.rate_hz,
                 .t0_s = markers.time.time_s(problem->first_frame),
                 .frames = problem->frames};

  Tracker tracker(*problem, options, markers, progress, result);
  const auto start = std::chrono::steady_clock::now();
  if (!tracker.run()) return fail(Code::cancelled, "inverse kinematics was stopped");
  result.solve_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  fill_coordinates(*problem, tracker.states(), motion);
  add_pull_costs(*problem, result);
  note_limits(*problem, result);

  if (options.error_bars) {
    MarkerVariances variances;
    if (options.marker_noise_sd_m > 0.0) {
      variances.own.setConstant(problem->model.marker_count(),
                                options.marker_noise_sd_m * options.marker_noise_sd_m);
      variances.common.setZero(static_cast<Eigen::Index>(problem->model.bodies().size()));
    } else {
      variances = estimate_variances(*problem, markers, tracker.states(), options.threads);
    }
    compute_error_bars(*problem, markers, tracker.states(), variances, options.threads, motion);
    flag_underdetermined(motion);
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
