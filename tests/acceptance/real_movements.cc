// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "acceptance/real_movements.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kinemark/math/digital_filter.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/control/internal/goal_curve.h"
#include "kinemark/stages/motion/ik.h"

namespace kinemark::testing_support {
namespace {

constexpr double kMovement_hz = 20.0, kMovementShare = 0.2;

/// Angles of a recording, without their noise, at another rate.
Eigen::MatrixXd angles(const IkCase& c, double rate_hz, TimeBase& time) {
  const auto motion = motion::solve_ik(c.model, c.markers, {.error_bars = false}).value().motion;
  Eigen::MatrixXd q(motion.size(), motion.frames());
  for (std::int64_t k = 0; k < motion.size(); ++k) {
    std::vector<double> one;
    for (std::int64_t f = 0; f < motion.frames(); ++f) one.push_back(motion.q[motion.index(f, k)]);
    const auto sections = math::butterworth_lowpass(
        2, math::two_pass_cutoff(2, std::min(kMovement_hz / motion.time.rate_hz, kMovementShare)));
    math::filter_both_ways(sections, math::usual_padding(2), one);
    for (std::int64_t f = 0; f < motion.frames(); ++f) q(k, f) = one[static_cast<std::size_t>(f)];
  }
  time = motion.time;
  if (rate_hz == time.rate_hz) return q;
  const auto curve = motion::internal::GoalCurve::through(q, time).value();
  const double duration_s = static_cast<double>(time.frames - 1) / time.rate_hz;
  time.rate_hz = rate_hz;
  time.frames = static_cast<std::int64_t>(std::floor(duration_s * rate_hz)) + 1;
  Eigen::MatrixXd out(q.rows(), time.frames);
  std::vector<double> values(static_cast<std::size_t>(3 * q.rows()));
  for (std::int64_t f = 0; f < time.frames; ++f) {
    curve.at(time.time_s(f), values);
    for (Eigen::Index k = 0; k < q.rows(); ++k) out(k, f) = values[static_cast<std::size_t>(k)];
  }
  return out;
}

}  // namespace

RealMovement real_movement(const IkCase& c, double rate_hz) {
  RealMovement truth;
  TimeBase time;
  truth.q = angles(c, rate_hz, time);
  std::vector<std::string> names;
  std::vector<int> of;
  for (int m = 0; m < c.model.marker_count(); ++m) {
    const auto& name = c.model.description().markers[static_cast<std::size_t>(m)].name;
    if (c.markers.find(name) < 0) continue;
    names.push_back(name), of.push_back(m);
  }
  truth.markers = data::Trajectories::all_missing(names, time);
  model::Workspace w(c.model);
  Eigen::VectorXd q;
  for (std::int64_t f = 0; f < time.frames; ++f) {
    q = truth.q.col(f);
    const auto state = model::state_from_coordinates(c.model, q);
    model::coordinates_from_state(c.model, state, truth.q.col(f), q);
    truth.q.col(f) = q;
    model::kinematics(c.model, w, state);
    for (std::size_t m = 0; m < of.size(); ++m) {
      const auto column = static_cast<std::int64_t>(m);
      truth.markers.x(f, column) = w.marker.col(of[m]);
      truth.markers.state[truth.markers.index(f, column)] = data::SampleState::measured;
    }
  }
  return truth;
}

}  // namespace kinemark::testing_support
