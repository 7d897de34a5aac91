// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/start.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/math/rotation_fit.h"
#include "kinemark/model/kinematics.h"

namespace kinemark::motion::internal {
namespace {

/// Root of a body: the free joint that carries it, or -1.
int free_joint_under(const model::Model& model, int body) {
  while (body >= 0 && model.bodies()[at(body)].free_joint < 0) body = model.bodies()[at(body)].parent;
  return body < 0 ? -1 : model.bodies()[at(body)].free_joint;
}

/// Move each free joint so that the markers it carries lie over the measured ones, all other coordinates as
/// they are.
void lay_over(const Problem& problem, model::Workspace& w, const Eigen::Matrix3Xd& y,
              const Eigen::VectorXd& weight, Eigen::VectorXd& x) {
  const auto& model = problem.model;
  model::kinematics(model, w, x);
  for (std::size_t j = 0; j < model.free_joints().size(); ++j) {
    const auto& free = model.free_joints()[j];
    Eigen::Vector3d from_centre = Eigen::Vector3d::Zero(), to_centre = Eigen::Vector3d::Zero();
    double total = 0.0;
    int count = 0;
    const auto carried = [&](Eigen::Index m) {
      return weight[m] > 0.0 && free_joint_under(model, model.markers()[at(m)].body) == static_cast<int>(j);
    };
    for (Eigen::Index m = 0; m < weight.size(); ++m) {
      if (!carried(m)) continue;
      from_centre += weight[m] * w.marker.col(m);
      to_centre += weight[m] * y.col(m);
      total += weight[m];
      ++count;
    }
    if (count == 0) continue;
    from_centre /= total;
    to_centre /= total;
    // Rotation that takes the model's markers to the measured ones.
    Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
    for (Eigen::Index m = 0; m < weight.size(); ++m)
      if (carried(m)) S += weight[m] * (y.col(m) - to_centre) * (w.marker.col(m) - from_centre).transpose();
    const Eigen::Matrix3d R = count >= 3 ? math::fit_rotation(S).rotation : Eigen::Matrix3d::Identity();
    // world_from_joint_out <- (R, to - R from) * itself; expressed in the parent's joint frame.
    const Eigen::Matrix3d& frame = w.joint_rotation[at(free.body)];
    const Eigen::Vector3d frame_origin = model.bodies()[at(free.body)].parent_from_joint.translation;
    const Eigen::Vector3d origin = frame_origin + frame * x.segment<3>(free.state_idx);
    const Eigen::Vector3d moved = to_centre + R * (origin - from_centre);
    const Eigen::Quaterniond rotation(
        Eigen::Matrix3d(frame.transpose() * R * w.joint_out_rotation[at(free.body)]));
    x.segment<3>(free.state_idx) = frame.transpose() * (moved - frame_origin);
    x.segment<4>(free.state_idx + 3) << rotation.w(), rotation.x(), rotation.y(), rotation.z();
    x.segment<4>(free.state_idx + 3).normalize();
  }
}

}  // namespace

FrameSolver::Outcome find_start(const Problem& problem, const IkOptions& options, FrameSolver& solver,
                                const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight, std::int64_t frame,
                                int starts, Eigen::VectorXd& x) {
  const auto& model = problem.model;
  const Eigen::VectorXd given = x;
  FrameSolver::Outcome best;
  int found = 0;  // how often the pose of least cost was found: three independent times are enough
  for (int start = 0; start < starts && found < 3; ++start) {
    Eigen::VectorXd candidate = given;
    if (start > 0) {
      // Even starts scatter around the given pose, odd ones lie anywhere within the limits or a quarter turn.
      Random random(options.seed, 0x73746172 + static_cast<std::uint64_t>(start));
      for (const auto& c : model.coordinates()) {
        const double u = random.uniform(-1.0, 1.0);
        if (c.speed_idx < 0 || problem.fixed_speed[at(c.speed_idx)]) continue;
        double& value = candidate[c.state_idx];
        const double low = std::max(problem.lower[c.speed_idx], -1.6),
                     high = std::min(problem.upper[c.speed_idx], 1.6);
        value = start % 2 == 0 ? value + 0.6 * u : 0.5 * (low + high) + 0.5 * (high - low) * u;
      }
    }
    lay_over(problem, solver.workspace(), y, weight, candidate);
    const auto outcome = solver.solve(y, weight, frame, candidate);
    const double margin = 1e-6 * best.cost + 1e-12;
    if (start == 0 || outcome.cost < best.cost - margin) {
      best = outcome;
      x = candidate;
      found = 1;
    } else if (outcome.cost <= best.cost + margin) {
      ++found;
    }
  }
  return best;
}

}  // namespace kinemark::motion::internal
