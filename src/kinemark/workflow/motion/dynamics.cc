// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/dynamics.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/workflow/motion/internal/held_motion.h"
#include "kinemark/workflow/motion/internal/rated_motion.h"

namespace kinemark::workflow {
namespace {

using internal::RatedMotion;

/// Where nobody measured the motion, neither coordinates nor torques have a number.
void withdraw_filled(const Array<std::uint8_t>& is_filled, data::JointMotion& motion) {
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    for (std::int64_t c = 0; c < motion.size(); ++c) {
      if (is_filled[motion.index(f, c)] == 0) continue;
      for (auto* values : {&motion.q, &motion.qd, &motion.qdd}) (*values)[motion.index(f, c)] = kNaN;
      for (auto* forces : {&motion.tau, &motion.tau_sd})
        if (!forces->empty()) std::fill_n(forces->begin() + motion.index(f, 0), motion.size(), kNaN);
    }
}

/// Derivatives of a coordinate (order 0), its speed (1) or acceleration (2) by q, qd, qdd of the one that it
/// is coupled to; without the coupling's third derivative.
Eigen::Vector3d coupled_derivatives(const math::ScalarFunction& coupling, double q, double qd, double qdd,
                                    int order) {
  const auto at_q = coupling(q);
  if (order == 0) return {at_q.df, 0.0, 0.0};
  if (order == 1) return {at_q.ddf * qd, at_q.df, 0.0};
  return {at_q.ddf * qdd, 2.0 * at_q.ddf * qd, at_q.df};
}

/// Standard deviation of q, qd or qdd of every coordinate; NaN where it is not determined.
Array<double> deviations_of(const model::Model& model, const RatedMotion& rated, int order) {
  const auto& motion = rated.motion;
  Array<double> sd(motion.q.size(), kNaN);
  for (std::int64_t c = 0; c < motion.size(); ++c) {
    const auto& coordinate = model.coordinates()[at(c)];
    const auto from = coordinate.source >= 0 ? coordinate.source : c;
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      const auto i = motion.index(f, from);
      if (motion.determined[i] == 0) continue;
      const auto p = motion::covariance_as_held(motion, rated.errors, f, from);
      Eigen::Matrix3d covariance;
      covariance << p[0], p[1], p[2], p[1], p[3], p[4], p[2], p[4], p[5];
      const Eigen::Vector3d by = from == c ? Eigen::Vector3d(Eigen::Vector3d::Unit(order))
                                           : coupled_derivatives(coordinate.coupling, motion.q[i],
                                                                 motion.qd[i], motion.qdd[i], order);
      sd[motion.index(f, c)] = std::sqrt(std::max(0.0, by.dot(covariance * by)));
    }
  }
  return sd;
}

/// How rates and deviations were found, in a sentence each.
void describe_method(const DynamicsOptions& options, const RatedMotion& rated, bool bars,
                     DynamicsFound& found) {
  if (options.cutoff_hz > 0.0) {
    found.facts.emplace_back("low-pass",
                             fmt::format("Butterworth, third order, both ways, {:g} Hz", options.cutoff_hz));
    found.remarks.warnings.push_back(fmt::format(
        "coordinates were low-passed at {:g} Hz: what that leaves of their noise is not known, and no "
        "deviations are written",
        options.cutoff_hz));
  }
  found.facts.emplace_back("rates", "each coordinate smoothed by itself, its bandwidth from its likelihood");
  found.facts.emplace_back("deviations", !bars ? "none"
                                         : rated.motion.q_sd.empty()
                                             ? "from the noise found in each coordinate"
                                             : "from those of the motion");
}

}  // namespace

Result<DynamicsFound> dynamics(const model::Model& model, const GivenMotion& given,
                               const DynamicsOptions& options) {
  auto rated = internal::rate_motion(model, given, options.cutoff_hz);
  if (!rated) return std::unexpected(rated.error());
  DynamicsFound found;
  motion::BodyMotionOptions follow = options;
  follow.error_bars = options.error_bars && options.cutoff_hz == 0.0;
  internal::hold_motion(model, given, options.mass_centre && !options.torques && !given.forces,
                        found.remarks);
  describe_method(options, *rated, follow.error_bars, found);
  if (!follow.body_idx.empty() || !follow.points.empty() || options.mass_centre) {
    auto bodies = motion::body_motion(model, rated->motion, follow, rated->errors, rated->is_filled);
    if (!bodies) return fail_at(given.names.motion, bodies.error());
    found.bodies = std::move(*bodies);
  }
  if (options.torques || given.forces) {
    auto torques = internal::find_torques(model, given, *rated,
                                          {.error_bars = follow.error_bars, .threads = options.threads});
    if (!torques) return std::unexpected(torques.error());
    std::ranges::move(torques->account.facts, std::back_inserter(found.facts));
    std::ranges::move(torques->account.warnings, std::back_inserter(found.remarks.warnings));
    std::ranges::move(torques->account.gates, std::back_inserter(found.remarks.gates));
  }
  if (follow.error_bars)
    for (int order = 0; order < 3; ++order) found.sd[at(order)] = deviations_of(model, *rated, order);
  found.motion = std::move(rated->motion);
  withdraw_filled(rated->is_filled, found.motion);
  return found;
}

}  // namespace kinemark::workflow
