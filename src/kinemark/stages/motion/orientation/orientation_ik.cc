// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/orientation_ik.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/orientation/internal/heading.h"
#include "kinemark/stages/motion/orientation/internal/sensor_errors.h"
#include "kinemark/stages/motion/orientation/internal/sensor_placement.h"
#include "kinemark/stages/motion/orientation/internal/sensor_samples.h"
#include "kinemark/stages/motion/orientation/internal/turning_model.h"

namespace kinemark::motion {
namespace {

using internal::Heading;
using internal::PosedSensors;

constexpr double kNominalNoise = 0.02;  // rad, where neither given nor in the residuals
constexpr double kHeadingStep = 1e-3;   // rad, by which the angles' slope on the heading is found
constexpr std::int64_t kTips = 3;       // of a sensor

Result<std::vector<std::int64_t>> frames_within(const data::Orientations& recording,
                                                const OrientationOptions& options) {
  const double slack = kTimeSlack / recording.time.rate_hz;
  std::vector<std::int64_t> frames;
  for (std::int64_t f = 0; f < recording.frames(); ++f) {
    const double t = recording.time.time_s(f);
    if (t >= options.first_time_s - slack && t <= options.last_time_s + slack) frames.push_back(f);
  }
  if (frames.empty())
    return fail(Code::bad_input,
                fmt::format("no frame in the time range; the recording has {} frames from {} to {} s",
                            recording.frames(), recording.time.t0_s,
                            recording.time.time_s(std::max<std::int64_t>(0, recording.frames() - 1))));
  return frames;
}

/// F x S angles between measured and model.
Array<double> errors_of(const data::JointMotion& motion, std::int64_t sensors) {
  Array<double> out(at(motion.frames() * sensors));
  for (std::size_t i = 0; i < out.size(); ++i) {
    double squares = 0.0;
    for (std::size_t k = 0; k < 3 * at(kTips); ++k) {
      const double e = motion.marker_error[3 * at(kTips) * i + k];
      squares += e * e;
    }
    out[i] = std::isnan(squares) ? kNaN : internal::angle_of_tips(squares);
  }
  return out;
}

/// Noise about each axis by the residuals: three numbers a sensor, less one for each coordinate that they
/// fix.
double noise_in_residuals(const data::ModelDescription& model, const data::JointMotion& motion,
                          const Array<double>& errors, std::size_t sensors) {
  auto fitted = internal::turning_coordinates(model);
  for (const auto& coupling : model.couplings) fitted[at(coupling.dependent_idx)] = false;
  for (std::size_t c = 0; c < fitted.size(); ++c) fitted[c] = fitted[c] && !model.coordinates[c].held();
  double squares = 0.0;
  std::int64_t freedom = 0;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    std::int64_t numbers = 0;
    for (std::size_t s = 0; s < sensors; ++s) {
      const double e = errors[at(f) * sensors + s];
      if (std::isnan(e)) continue;
      squares += e * e;
      numbers += 3;
    }
    for (std::int64_t c = 0; c < motion.size(); ++c)
      numbers -= fitted[at(c)] && motion.determined[motion.index(f, c)] != 0;
    freedom += std::max<std::int64_t>(0, numbers);
  }
  return freedom > 0 ? std::sqrt(squares / static_cast<double>(freedom)) : kNaN;
}

/// Coordinates that only move stay at their defaults; a frame is underdetermined where one that turns is.
/// @return  their names
std::vector<std::string> keep_lengths(const model::Model& model, data::JointMotion& motion) {
  const auto turns = internal::turning_coordinates(model.description());
  std::vector<std::string> at_default;
  for (std::size_t c = 0; c < turns.size(); ++c)
    if (!turns[c]) at_default.push_back(motion.coordinates[c]);
  const bool has_bars = !motion.determined.empty();
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    bool open = false;
    for (std::int64_t c = 0; c < motion.size(); ++c) {
      const auto i = motion.index(f, c);
      const auto& coordinate = model.description().coordinates[at(c)];
      if (turns[at(c)]) {
        open = open || (has_bars && motion.determined[i] == 0);
        continue;
      }
      if (!coordinate.held()) motion.q[i] = coordinate.default_value;
      if (!has_bars) continue;
      motion.determined[i] = coordinate.held();
      motion.q_sd[i] = coordinate.held() ? 0.0 : kNaN;
    }
    auto& status = motion.status[at(f)];
    if (status == data::FrameStatus::underdetermined && !open) status = data::FrameStatus::converged;
  }
  return at_default;
}

/// What the heading does not know adds to what the sensors do not.
void add_heading(const data::JointMotion& other, double step_rad, double heading_sd_rad,
                 data::JointMotion& motion) {
  // Angles may have gone to another turn; lengths do not differ.
  for (std::size_t i = 0; i < motion.q.size(); ++i)
    motion.q_sd[i] =
        std::hypot(motion.q_sd[i], std::remainder(other.q[i] - motion.q[i], 2.0 * std::numbers::pi) /
                                       step_rad * heading_sd_rad);
}

/// Progress of one of several solutions of the same frames, which are counted once.
Progress share_of(const Progress& progress, std::int64_t pass, std::int64_t passes) {
  if (!progress) return {};
  return [&progress, pass, passes](std::int64_t done, std::int64_t total) {
    return progress((pass * total + done) / passes, total);
  };
}

}  // namespace

Status OrientationOptions::check() const {
  if (!(noise_sd_rad >= 0.0) || !std::isfinite(noise_sd_rad))
    return fail(Code::bad_input,
                fmt::format("the noise of orientations is {} rad; need 0 or more", noise_sd_rad));
  if (!up_in_world.allFinite()) return fail(Code::bad_input, "the vertical of the sensors is not finite");
  if (facing && !(facing->axis.norm() > 0.0))
    return fail(Code::bad_input, "the axis that faces forward is 0");
  if (std::isnan(first_time_s) || std::isnan(last_time_s) || threads < 0)
    return fail(Code::bad_input, "times and threads of the inverse kinematics of orientations are not valid");
  return {};
}

Result<OrientationResult> solve_orientations(const model::Model& model, const data::Orientations& recording,
                                             const data::Orientations* pose,
                                             const OrientationOptions& options, const Progress& progress) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = recording.validate(); !s) return std::unexpected(s.error());
  if (pose != nullptr)
    if (auto s = pose->validate(); !s) return std::unexpected(s.error());
  if (options.judge_samples) {
    const auto judged = internal::judge_sensors(recording, pose);
    auto as_given = options;
    as_given.judge_samples = false;
    auto found = solve_orientations(model, judged.recording, judged.pose_or_null(), as_given, progress);
    if (found) judged.account(found->motion.time, found->fit);
    return found;
  }
  const auto start = std::chrono::steady_clock::now();
  const auto frames = frames_within(recording, options);
  if (!frames) return std::unexpected(frames.error());
  auto posed = internal::pose_sensors(model, recording, pose, options);
  if (!posed) return std::unexpected(posed.error());
  OrientationResult out;
  auto& fit = out.fit;
  if (auto s = internal::drop_unseen(recording, *frames, *posed, fit.never_seen); !s)
    return std::unexpected(s.error());
  Heading heading;
  if (posed->by_model) {
    // As it is.
  } else if (options.facing) {
    const auto given = internal::heading_of(*posed, recording, *options.facing);
    if (!given) return std::unexpected(given.error());
    heading.rad = *given;
  } else {
    const auto found = internal::estimate_heading(model, recording, *posed, *frames, options);
    if (!found) return std::unexpected(found.error());
    heading = *found;
  }

  // By a noise that is assumed, by that of the residuals, and with the heading a step further.
  const std::int64_t passes = !options.error_bars ? 1 : heading.sd_rad > 0.0 ? 3 : 2;
  std::int64_t pass = 0;
  const auto solve = [&](double heading_rad, double noise_sd_rad) {
    return internal::solve_turned(model.description(), recording, *posed, *frames, heading_rad,
                                  {.limits = options.limits,
                                   .marker_noise_sd_m = internal::kTipNoise_m * noise_sd_rad,
                                   .judge_samples = false,
                                   .error_bars = noise_sd_rad > 0.0,
                                   .seed = options.seed,
                                   .threads = options.threads},
                                  share_of(progress, pass++, passes));
  };
  const double first_noise = options.noise_sd_rad > 0.0 ? options.noise_sd_rad : kNominalNoise;
  auto solved = solve(heading.rad, options.error_bars ? first_noise : 0.0);
  if (!solved) return std::unexpected(solved.error());
  fit.first_frame = frames->front();
  fit.left_out = posed->left_out;
  fit.pose_drift_rad = posed->drift_rad;
  fit.heading_rad = heading.rad;
  fit.heading_sd_rad = heading.sd_rad;
  fit.heading_source = posed->by_model  ? HeadingSource::model
                       : options.facing ? HeadingSource::facing
                                        : HeadingSource::motion;
  for (const auto& sensor : posed->sensors)
    fit.sensors.push_back({.name = recording.names[at(sensor.column)],
                           .body = model.description().bodies[at(sensor.body_idx)].name,
                           .body_from_sensor = internal::body_from_sensor(*posed, sensor, heading.rad),
                           .placed_by = posed->by_model ? SensorPlacement::model : SensorPlacement::pose});
  out.error_rad = errors_of(solved->motion, static_cast<std::int64_t>(fit.sensors.size()));
  internal::summarize_errors(out.error_rad, fit);
  if (options.noise_sd_rad > 0.0)
    // The pose is measured with the same noise as every frame.
    fit.noise_sd_rad =
        options.noise_sd_rad *
        (posed->by_model ? 1.0 : std::sqrt(1.0 + 1.0 / static_cast<double>(posed->pose_frames)));
  else if (options.error_bars)
    fit.noise_sd_rad =
        noise_in_residuals(model.description(), solved->motion, out.error_rad, fit.sensors.size());
  if (options.error_bars && fit.noise_sd_rad > 0.0) {
    solved = solve(heading.rad, fit.noise_sd_rad);
    if (!solved) return std::unexpected(solved.error());
    if (heading.sd_rad > 0.0) {
      const auto other = solve(heading.rad + kHeadingStep, 0.0);
      if (!other) return std::unexpected(other.error());
      add_heading(other->motion, kHeadingStep, heading.sd_rad, solved->motion);
    }
  } else if (options.error_bars) {
    std::ranges::fill(solved->motion.q_sd, kNaN);  // of a noise that nobody knows
  }
  out.motion = std::move(solved->motion);
  out.motion.markers.clear();
  out.motion.marker_error.clear();
  out.motion.marker_state.clear();
  fit.at_default = keep_lengths(model, out.motion);
  out.solve_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace kinemark::motion
