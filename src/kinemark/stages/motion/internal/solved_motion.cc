// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/solved_motion.h"

#include <algorithm>

#include "kinemark/core/index.h"
#include "kinemark/model/state.h"

namespace kinemark::motion::internal {

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

void note_limits(const Problem& problem, const data::JointMotion& motion, data::MarkerFit& fit) {
  const auto coordinates = problem.model.coordinates();
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    const int speed = coordinates[c].speed_idx;
    if (speed < 0 || problem.fixed_speed[at(speed)]) continue;
    std::int64_t leaning = 0;
    for (std::int64_t f = 0; f < problem.frames; ++f) {
      const double q = motion.q[motion.index(f, static_cast<std::int64_t>(c))];
      leaning += q <= problem.lower[speed] + 1e-9 || q >= problem.upper[speed] - 1e-9;
    }
    if (10 * leaning > problem.frames)
      fit.findings.push_back({.kind = data::FindingKind::at_limit,
                              .subject = motion.coordinates[c],
                              .size = static_cast<double>(leaning) / static_cast<double>(problem.frames)});
  }
}

void flag_underdetermined(data::JointMotion& motion) {
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const auto* row = motion.determined.data() + motion.index(f, 0);
    if (motion.status[at(f)] == data::FrameStatus::converged &&
        std::any_of(row, row + motion.size(), [](auto d) { return d == 0; }))
      motion.status[at(f)] = data::FrameStatus::underdetermined;
  }
}

}  // namespace kinemark::motion::internal
