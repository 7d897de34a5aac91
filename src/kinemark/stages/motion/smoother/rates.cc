// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/rates.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/model/coordinate_rates.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/smoother/coordinate_smoother.h"

namespace kinemark::motion {
namespace {

/// Rates of coupled coordinates from those of the ones that drive them.
void couple_rates(const model::Model& model, data::JointMotion& motion) {
  const auto coordinates = model.coordinates();
  if (std::ranges::none_of(coordinates, [](const auto& c) { return c.source >= 0; })) return;
  const int n = model.coordinate_count();
  model::Workspace w(model);
  Eigen::VectorXd q(n), qd(n), qdd(n), v, vdot, all_qd, all_qdd;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    for (int c = 0; c < n; ++c) {
      q[c] = motion.q[motion.index(f, c)];
      qd[c] = motion.qd[motion.index(f, c)];
      qdd[c] = motion.qdd[motion.index(f, c)];
    }
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    model::speeds_from_rates(model, q, qd, qdd, v, vdot);
    model::rates_from_speeds(model, w, q, v, vdot, all_qd, all_qdd);
    for (int c = 0; c < n; ++c) {
      if (coordinates[at(c)].source < 0) continue;
      motion.qd[motion.index(f, c)] = all_qd[c];
      motion.qdd[motion.index(f, c)] = all_qdd[c];
    }
  }
}

/// Rates of a prescribed coordinate whose values are those of its function; false where they are others.
bool prescribed_rates(const math::ScalarFunction& function, const data::JointMotion& motion, std::int64_t c,
                      Array<double>& v, Array<double>& a) {
  constexpr double kSame = 1e-6;  // rad or m: digits of a motion file
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const auto i = motion.index(f, c);
    const auto value = function(motion.time.time_s(f));
    if (!(std::abs(value.f - motion.q[i]) <= kSame)) return false;
    v[i] = value.df;
    a[i] = value.ddf;
  }
  return true;
}

}  // namespace

Result<RateErrors> estimate_rates(const model::Model& model, data::JointMotion& motion) {
  check(motion.size() == model.coordinate_count(), "motion and model have different coordinates");
  if (auto status = motion.validate(); !status) return std::unexpected(status.error());
  const std::int64_t F = motion.frames(), n = motion.size();
  if (F < kFewestSamples)
    return fail(Code::bad_input,
                fmt::format("the motion has {} frames; rates of change need {} or more", F, kFewestSamples));
  RateErrors errors;
  errors.covariance.assign(at(6 * F * n), kNaN);
  errors.noise_scale.assign(at(n), 0.0);
  Array<double> v(at(F * n), 0.0), a(at(F * n), 0.0);
  std::vector<double> y(at(F)), sd;
  for (std::int64_t c = 0; c < n; ++c) {
    const auto& coordinate = model.coordinates()[at(c)];
    const auto& described = model.description().coordinates[at(c)];
    const bool still = described.locked || (coordinate.speed_idx < 0 && coordinate.free_joint < 0);
    if (coordinate.source >= 0) continue;
    if (still || (described.prescribed && prescribed_rates(*described.prescribed, motion, c, v, a))) {
      for (std::int64_t f = 0; f < F; ++f)
        std::fill_n(errors.covariance.begin() + 6 * static_cast<std::ptrdiff_t>(motion.index(f, c)), 6, 0.0);
      continue;
    }
    sd.clear();
    if (!motion.q_sd.empty() || !motion.determined.empty()) sd.assign(at(F), 1.0);
    for (std::int64_t f = 0; f < F; ++f) {
      const auto i = motion.index(f, c);
      y[at(f)] = motion.q[i];
      if (!motion.q_sd.empty()) sd[at(f)] = motion.q_sd[i];
      if (!motion.determined.empty() && motion.determined[i] == 0) sd[at(f)] = kNaN;
    }
    const auto smooth = smooth_coordinate(y, sd, motion.time.rate_hz);
    errors.noise_scale[at(c)] = smooth.noise_scale;
    for (std::int64_t f = 0; f < F; ++f) {
      const auto i = motion.index(f, c);
      v[i] = smooth.rate[f];
      a[i] = smooth.acceleration[f];
      for (std::int64_t k = 0; k < 6; ++k) errors.covariance[6 * i + at(k)] = smooth.covariance(k, f);
    }
  }
  const bool own = motion.qd.empty() || motion.qdd.empty();
  if (own) {
    motion.qd = std::move(v);
    motion.qdd = std::move(a);
    couple_rates(model, motion);
  }
  return errors;
}

std::array<double, 6> covariance_as_held(const data::JointMotion& motion, const RateErrors& errors,
                                         std::int64_t frame, std::int64_t coordinate) {
  const auto i = motion.index(frame, coordinate);
  std::array<double, 6> out{};
  std::copy_n(errors.covariance.begin() + 6 * static_cast<std::ptrdiff_t>(i), 6, out.begin());
  const double scale = errors.noise_scale.empty() ? 0.0 : errors.noise_scale[at(coordinate)];
  const double sd = motion.q_sd.empty() ? scale : motion.q_sd[i];
  out[0] = std::max(out[0], sd * sd);
  return out;
}

}  // namespace kinemark::motion
