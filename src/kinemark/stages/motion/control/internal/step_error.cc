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

constexpr double kShare = 0.2;                    // of what angles are known to: noise grows with it, by 5 %
constexpr double kLeast_rad = 0.01 * kRadPerDeg;  // nobody needs less
constexpr double kShortest_s = 1e-4;
constexpr double kLeft = 2.0;
constexpr int kTimesFiner = 4;
constexpr double kCompared_s = 1.0, kSkipped_s = 0.1;  // of a stretch; until the finer body has its speeds
constexpr std::int64_t kMostStretches = 10;
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

double tolerated_cost(double known) { return std::max(kShare * known, kLeast_rad); }

Plan with_finer_steps(const Plan& plan) {
  Plan finer = plan;
  finer.steps_per_frame = kTimesFiner * plan.steps_per_frame;
  finer.step_s = 1.0 / (plan.rate_hz * finer.steps_per_frame);
  const double omega = kOmegaStep / finer.step_s;
  finer.kp = omega * omega;
  finer.kd = 2.0 * omega;
  return finer;
}

double step_cost(const Plan& plan, const Eigen::MatrixXd& states, Walker& finer) {
  const auto& model = plan.problem.model;
  const std::int64_t length = std::max<std::int64_t>(2, std::llround(kCompared_s * plan.rate_hz)),
                     skipped = static_cast<std::int64_t>(std::ceil(kSkipped_s * plan.rate_hz)),
                     whole = length + skipped, frames = plan.problem.frames,
                     apart = std::max(whole, frames / kMostStretches);
  double squares = 0.0, count = 0.0;
  for (std::int64_t begin = 0; begin + skipped < frames; begin += apart) {
    finer.begin(states.col(begin), begin);
    for (std::int64_t f = begin + 1; f < std::min(frames, begin + whole); ++f) {
      finer.next();
      if (f < begin + skipped || finer.flagged()) continue;
      for (int i = 0; i < model.coordinate_count(); ++i) {
        const auto& c = model.coordinates()[at(i)];
        if (c.speed_idx < 0 || !model.description().coordinates[at(i)].is_rotation ||
            plan.problem.fixed_speed[at(c.speed_idx)] != 0)
          continue;
        const double off = finer.controller().x()[c.state_idx] - states(c.state_idx, f);
        squares += off * off;
        count += 1.0;
      }
    }
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

double step_for(double step_s, double cost, double most) {
  // At omega = 0.5 / step the error grows with the third power of the step.
  double shorter_s = step_s;
  for (int parts = 1; shorter_s > kShortest_s && !(cost * std::pow(shorter_s / step_s, 3) <= most);)
    shorter_s = step_s / ++parts;
  return shorter_s;
}

std::string warn_of_step(const Plan& plan, double cost, double known) {
  if (!(cost > tolerated_cost(known))) return {};
  const double shorter_s = step_for(plan.step_s, cost, tolerated_cost(known));
  return fmt::format(
      "steps of {:.3g} ms at omega {:.3g} rad/s cost {:.2g} deg of angles that are known to {:.2g} deg; "
      "--step {:.3g} --omega {:.3g} does not",
      1e3 * plan.step_s, std::sqrt(plan.kp), kDegPerRad * cost, kDegPerRad * known, 1e3 * shorter_s,
      kOmegaStep / shorter_s);
}

}  // namespace kinemark::motion::internal
