// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/first_pose.h"

#include <algorithm>

#include "kinemark/core/index.h"
#include "kinemark/stages/motion/internal/frame_solver.h"
#include "kinemark/stages/motion/internal/start.h"

namespace kinemark::motion::internal {
namespace {

constexpr std::int64_t kPosesChecked = 100;  // poses, to find coordinates that no goal moves
constexpr std::int64_t kInstants = 8;        // of the recording, at which tasks are evaluated

/// First frame with at least 95 % as many goals as the best one.
std::int64_t find_anchor(const Problem& p, const data::Trajectories& goals) {
  std::vector<int> seen(at(p.frames), 0);
  for (std::int64_t f = 0; f < p.frames; ++f)
    for (const int m : p.data_marker) seen[at(f)] += goals.present(p.first_frame + f, m);
  const int best = *std::max_element(seen.begin(), seen.end());
  return std::find_if(seen.begin(), seen.end(), [&](int n) { return 20 * n >= 19 * best; }) - seen.begin();
}

/// Free roots rest where the body starts.
void rest_roots(Plan& plan, const Eigen::VectorXd& x) {
  for (const auto& free : plan.problem.model.free_joints())
    plan.rest.segment<7>(free.state_idx) = x.segment<7>(free.state_idx);
}

/// Coordinates that tasks hold begin there, the others where the markers then put them.
void begin_held(const Plan& plan, const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight,
                Eigen::VectorXd& x) {
  if (plan.held.empty()) return;
  Problem held = plan.problem;
  for (const auto& [coordinate, value] : plan.held) {
    const auto& c = held.model.coordinates()[at(coordinate)];
    x[c.state_idx] = value;
    held.fixed_speed[at(c.speed_idx)] = 1;
  }
  if (weight.sum() > 0.0) FrameSolver(held, plan.start_options).solve(y, weight, 0, x);
}

}  // namespace

Eigen::VectorXd find_first_pose(Plan& plan, const data::Trajectories& goals, LockMode lock) {
  const auto& p = plan.problem;
  Eigen::Matrix3Xd y(3, p.model.marker_count());
  Eigen::VectorXd weight(p.model.marker_count());
  const std::int64_t anchor = find_anchor(p, goals);
  p.observe(goals, anchor, y, weight);
  Eigen::VectorXd x = plan.rest;
  {
    FrameSolver solver(p, plan.start_options);
    if (weight.sum() > 0.0)
      find_start(p, plan.start_options, solver, y, weight, 0, plan.start_options.starts, x);
    if (lock == LockMode::automatic) {
      IdlePoses idle_poses;
      idle_poses.around = poses_around(plan, x);
      if (plan.settle) {
        Eigen::VectorXd pose = x;
        const std::int64_t stride = std::max<std::int64_t>(1, p.frames / kPosesChecked);
        for (std::int64_t f = anchor; f < p.frames; f += stride) {
          p.observe(goals, f, y, weight);
          if (weight.sum() > 0.0) solver.solve(y, weight, 0, pose);
          idle_poses.followed.push_back(pose);
        }
      } else {
        idle_poses.followed = idle_poses.around;
        idle_poses.followed.push_back(x);
      }
      idle_poses.times_s.clear();
      for (std::int64_t i = 0; i <= kInstants; ++i)
        idle_poses.times_s.push_back(goals.time.time_s(p.first_frame + i * (p.frames - 1) / kInstants));
      lock_idle(plan, idle_poses);
    }
  }
  plan.apply_locks(x);
  FrameSolver solver(p, plan.start_options);  // with the locks applied
  for (std::int64_t f = anchor; f >= 0; --f) {
    p.observe(goals, f, y, weight);
    if (weight.sum() > 0.0) solver.solve(y, weight, 0, x);
  }
  begin_held(plan, y, weight, x);
  rest_roots(plan, x);
  return x;
}

Eigen::VectorXd find_first_pose(Plan& plan, const Eigen::Matrix3Xd& goal, const Eigen::VectorXd& weight,
                                LockMode lock) {
  const auto& p = plan.problem;
  Eigen::VectorXd x = plan.rest;
  {
    FrameSolver solver(p, plan.start_options);
    find_start(p, plan.start_options, solver, goal, weight, 0, plan.start_options.starts, x);
  }
  if (lock == LockMode::automatic) {
    IdlePoses idle_poses{.followed = poses_around(plan, x)};
    idle_poses.around = idle_poses.followed;
    idle_poses.followed.push_back(x);
    lock_idle(plan, idle_poses);
  }
  plan.apply_locks(x);
  FrameSolver solver(p, plan.start_options);
  solver.solve(goal, weight, 0, x);
  begin_held(plan, goal, weight, x);
  rest_roots(plan, x);
  return x;
}

}  // namespace kinemark::motion::internal
