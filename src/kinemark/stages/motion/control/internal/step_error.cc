// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/step_error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kShare = 0.3;                    // of what angles are known to: it adds 4 % to that
constexpr double kLeast_rad = 0.01 * kRadPerDeg;  // nobody needs less
constexpr double kShortest_s = 1e-4;
constexpr double kLeft = 2.0;
constexpr double kOmegaStep = 0.5;  // half of the limit of stability

/// RMS over angles of joints of a number per frame and coordinate; NaN where there is none.
template <typename Number>
double rms(const model::Model& model, const data::JointMotion& motion, const Number& number) {
  double squares = 0.0;
  std::int64_t count = 0;
  for (std::int64_t c = 0; c < motion.size(); ++c) {
    if (motion.is_rotation[at(c)] == 0 || model.coordinates()[at(c)].speed_idx < 0) continue;
    for (std::int64_t f = 1; f + 1 < motion.frames(); ++f) {
      const double value = number(f, c);
      if (!std::isfinite(value)) continue;
      squares += value * value;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : kNaN;
}

/// RMS of q''', rad/s^3. Frames beside one in which the body was set anew have none.
double find_jerk(const model::Model& model, const data::JointMotion& motion) {
  const auto sound = [&](std::int64_t f) { return motion.status[at(f)] != data::FrameStatus::not_converged; };
  return rms(model, motion, [&](std::int64_t f, std::int64_t c) {
    if (!sound(f - 1) || !sound(f) || !sound(f + 1)) return kNaN;
    return 0.5 * motion.time.rate_hz *
           (motion.qdd[motion.index(f + 1, c)] - motion.qdd[motion.index(f - 1, c)]);
  });
}

// What a step leaves whose acceleration is that of its beginning, times what is left of it when it aims at
// the middle: 0.25 was measured at omega h = 0.25 and 0.59 at 0.5.
double error_of(double jerk, double step_s, double omega) {
  return kLeft * omega * step_s * step_s * jerk / (2.0 * omega * omega) * (1.0 - omega * step_s / 3.0);
}

}  // namespace

double step_error(const model::Model& model, const data::JointMotion& motion, double step_s,
                  double omega_rad_s) {
  return error_of(find_jerk(model, motion), step_s, omega_rad_s);
}

double stated_error(const model::Model& model, const data::JointMotion& motion) {
  if (motion.q_sd.empty()) return kNaN;
  return rms(model, motion, [&](std::int64_t f, std::int64_t c) { return motion.q_sd[motion.index(f, c)]; });
}

double step_for(const model::Model& model, const data::JointMotion& motion, double most) {
  const double jerk = find_jerk(model, motion), frame_s = 1.0 / motion.time.rate_hz;
  double step_s = frame_s;
  for (int parts = 1; step_s > kShortest_s && !(error_of(jerk, step_s, kOmegaStep / step_s) <= most);)
    step_s = frame_s / ++parts;
  return step_s;
}

std::string warn_of_step(const model::Model& model, const data::JointMotion& motion, double step_s,
                         double omega_rad_s) {
  const double error = step_error(model, motion, step_s, omega_rad_s), known = stated_error(model, motion);
  if (!(error > kShare * known && error > kLeast_rad)) return {};
  const double shorter_s = step_for(model, motion, std::max(kShare * known, kLeast_rad));
  return fmt::format(
      "steps of {:.3g} ms at omega {:.3g} rad/s may cost {:.2g} deg of angles that are known to {:.2g} deg; "
      "--step {:.3g} --omega {:.3g} does not",
      1e3 * step_s, omega_rad_s, kDegPerRad * error, kDegPerRad * known, 1e3 * shorter_s,
      kOmegaStep / shorter_s);
}

}  // namespace kinemark::motion::internal
