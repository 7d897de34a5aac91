// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/rig_recording.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/check.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/simulation/internal/rig_frame.h"

namespace kinemark::simulation {
namespace {

using Eigen::Vector3d;

/// Where a frame of the recording is.
internal::FramePlace place_of(std::int64_t f, RigRecording& out) {
  const std::size_t at = out.counts.index(f, 0, 0),
                    dark_at = static_cast<std::size_t>(f) * out.counts.dark_time_s.size();
  return {.counts = out.counts.counts.data() + 4 * at,
          .dark = out.counts.dark.data() + dark_at,
          .flags = out.counts.flags.data() + at,
          .hidden = out.hidden.data() + at};
}

/// Velocity and acceleration of a smooth function of time by central differences of the fourth order.
template <class F>
void differentiate(const F& x, double t, double* velocity, double* acceleration) {
  constexpr double h = 1e-4, w = 1e-3;
  const Vector3d v = (x(t - 2 * h) - 8.0 * x(t - h) + 8.0 * x(t + h) - x(t + 2 * h)) / (12.0 * h);
  const Vector3d a =
      (-x(t - 2 * w) + 16.0 * x(t - w) - 30.0 * x(t) + 16.0 * x(t + w) - x(t + 2 * w)) / (12.0 * w * w);
  Eigen::Map<Vector3d>(velocity, 3) = v;
  Eigen::Map<Vector3d>(acceleration, 3) = a;
}

void truth_of_frame(const RigScene& scene, std::int64_t f, RigRecording& out) {
  for (int led = 0; led < static_cast<int>(scene.leds.size()); ++led) {
    const auto put = [&](data::Trajectories& where) {
      const LedState state = scene.led(led, where.time_s(f, led));
      if (!state.shining) return;
      where.x(f, led) = state.x_in_world;
      where.state[where.index(f, led)] = data::SampleState::measured;
    };
    put(out.truth);
    put(out.when_lit);
    if (!out.truth.present(f, led)) continue;
    const auto x = [&](double t) -> Vector3d {
      const LedState state = scene.led(led, t);
      if (!state.shining) return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
      return state.x_in_world;
    };
    const std::size_t at = 3 * out.truth.index(f, led);
    differentiate(x, out.truth.time_s(f, led), &out.derivatives.velocity[at],
                  &out.derivatives.acceleration[at]);
  }
}

RigRecording prepare(const PhysicalRig& rig, const RigScene& scene, const RigRecordingOptions& options) {
  RigRecording out;
  const TimeBase time{.rate_hz = options.rate_hz, .t0_s = options.t0_s, .frames = options.frames};
  const auto& timing = rig.rig.timing;
  out.counts = internal::layout_of(rig, scene.leds, time);
  const int C = rig.rig.camera_count(), L = static_cast<int>(scene.leds.size());
  out.truth = out.when_lit = data::Trajectories::all_missing(scene.leds, time);
  for (int l = 0; l < L; ++l)
    out.when_lit.sample_offset_s.push_back(
        0.5 * (timing.conversion_offset_s(l, 0, 0, C) + timing.conversion_offset_s(l, C - 1, 3, C)) -
        rig.rig.electronics.time_constant_s);
  out.derivatives.velocity.assign(out.truth.x_in_world.size(), std::numeric_limits<double>::quiet_NaN());
  out.derivatives.acceleration = out.derivatives.velocity;
  out.derivatives.filters.assign(scene.leds.size(),
                                 {.method = "none", .cutoff_hz = std::numeric_limits<double>::quiet_NaN()});
  out.hidden.assign(out.counts.flags.size(), 0);
  return out;
}

}  // namespace

Status RigRecordingOptions::check(const data::Rig& rig, int leds) const {
  if (leds < 1 || leds > kMostLeds)
    return fail(Code::usage, fmt::format("the rig drives 1 to {} LEDs; the scene has {}", kMostLeds, leds));
  if (!(rate_hz > 0.0) || !std::isfinite(rate_hz) || !std::isfinite(t0_s))
    return fail(Code::usage,
                fmt::format("{} frames per second from {} s; need a positive rate", rate_hz, t0_s));
  if (frames < 1 || frames > 10'000'000 / leds)
    return fail(Code::usage,
                fmt::format("{} frames of {} LEDs; need 1 to 10 million observations", frames, leds));
  if (!intensity.empty() && intensity.size() != static_cast<std::size_t>(leds))
    return fail(Code::usage, fmt::format("{} intensities for {} LEDs", intensity.size(), leds));
  for (const double i : intensity)
    if (!(i >= 0.0) || !(i <= 1000.0))
      return fail(Code::usage, fmt::format("an LED of intensity {}; need 0 to 1000", i));
  const double highest = rig.timing.highest_rate_hz(leds, rig.camera_count());
  if (rate_hz > highest * (1.0 + 1e-9))
    return fail(
        Code::usage,
        fmt::format("{} LED{}{} in slots of {:.0f} us leave room for {:.1f} frames per second at most; {} "
                    "were asked for",
                    leds, leds == 1 ? "" : "s", rig.timing.dark_slot ? " and a dark slot" : "",
                    1e6 * rig.timing.slot_s(rig.camera_count()), highest, rate_hz));
  return {};
}

Result<RigRecording> record(const PhysicalRig& rig, const RigScene& scene,
                            const RigRecordingOptions& options) {
  if (auto s = options.check(rig.rig, static_cast<int>(scene.leds.size())); !s)
    return std::unexpected(s.error());
  kinemark::check(static_cast<bool>(scene.led), "a scene says where its LEDs are");
  RigRecording out = prepare(rig, scene, options);
  parallel_for(options.frames, 64, options.threads, [&](std::int64_t begin, std::int64_t end) {
    const internal::FrameConverter converter(rig, scene, options, out.counts);
    for (std::int64_t f = begin; f < end; ++f) {
      converter.convert(f, place_of(f, out));
      truth_of_frame(scene, f, out);
    }
  });
  return out;
}

}  // namespace kinemark::simulation
