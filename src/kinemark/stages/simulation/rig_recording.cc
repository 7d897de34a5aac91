// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/rig_recording.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinemark/camera/noise.h"
#include "kinemark/core/check.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"

namespace kinemark::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using std::numbers::pi;

constexpr std::uint64_t kDrawsPerFrame = 8;  ///< four Gaussians of two uniforms each
constexpr std::uint64_t kDarkStream = std::uint64_t{1} << 32;

class Recorder {
 public:
  Recorder(const PhysicalRig& rig, const RigScene& scene, const RigRecordingOptions& options,
           RigRecording& out)
      : rig_(rig), scene_(scene), options_(options), out_(out) {}

  void frame(std::int64_t f) {
    for (int led = 0; led < leds(); ++led)
      for (int camera = 0; camera < cameras(); ++camera) observe(f, led, camera);
    if (!out_.counts.has_dark_slot()) return;
    for (int camera = 0; camera < cameras(); ++camera) dark(f, camera);
  }

 private:
  [[nodiscard]] int leds() const { return static_cast<int>(scene_.leds.size()); }
  [[nodiscard]] int cameras() const { return rig_.rig.camera_count(); }
  [[nodiscard]] double intensity(int led) const {
    return options_.intensity.empty() ? 1.0 : options_.intensity[static_cast<std::size_t>(led)];
  }

  [[nodiscard]] bool occluded(std::int64_t f, int led, int camera) const {
    return std::ranges::any_of(scene_.occlusions, [&](const Occlusion& o) {
      return o.led == led && (o.camera < 0 || o.camera == camera) && f >= o.first_frame && f <= o.last_frame;
    });
  }

  void observe(std::int64_t f, int led, int camera) {
    const auto offsets = out_.counts.offset_s(led, camera);
    const bool blocked = occluded(f, led, camera);
    std::uint8_t why = blocked ? kHiddenOccluded : 0;
    Vector4d expected, time_s;
    for (int k = 0; k < 4; ++k) {
      time_s[k] = out_.counts.time.time_s(f) + offsets[k];
      LedState state = scene_.led(led, time_s[k] - rig_.rig.electronics.time_constant_s);
      if (!state.shining) why |= kHiddenDark;
      LedState seen = state;
      // Light by way of the room comes although the LED itself is hidden: it is put behind the camera.
      if (blocked) seen.x_in_world = behind(camera);
      const auto counts = expected_counts(rig_, camera, seen, intensity(led));
      if (!blocked && !counts.on_sheet) why |= kHiddenOffSheet;
      expected[k] = counts.counts[k];
      if (blocked || !scene_.reflection) continue;
      const Reflection mirror = scene_.reflection(led, time_s[k], state.x_in_world);
      if (mirror.share > 0.0)
        expected[k] +=
            reflected_counts(rig_, camera, state, intensity(led), mirror.position_in_world, mirror.share)[k];
    }
    const std::size_t at = out_.counts.index(f, led, camera);
    const auto block = static_cast<std::uint64_t>(led * cameras() + camera);
    const bool full =
        convert(expected, time_s, camera, options_.stream, block, f, out_.counts.counts.data() + 4 * at);
    if (full) out_.counts.flags[at] |= data::kCountSaturated;
    out_.hidden[at] = why;
  }

  [[nodiscard]] Vector3d behind(int camera) const {
    const auto& pose = rig_.rig.cameras[static_cast<std::size_t>(camera)].cam_from_world;
    return pose.inverse() * Vector3d(0.0, 0.0, -1.0);
  }

  void dark(std::int64_t f, int camera) {
    const auto offsets = out_.counts.dark_offset_s(camera);
    const Vector4d time_s = offsets.array() + out_.counts.time.time_s(f);
    convert(rig_.rig.cameras[static_cast<std::size_t>(camera)].detector.offset_counts, time_s, camera,
            options_.stream + kDarkStream, static_cast<std::uint64_t>(camera), f,
            out_.counts.dark.data() + 4 * (f * cameras() + camera));
  }

  /// Flicker, noise and the converter; true when a channel is at its highest code.
  bool convert(Vector4d expected, const Vector4d& time_s, int camera, std::uint64_t stream,
               std::uint64_t block, std::int64_t f, std::int16_t* codes) const {
    const auto& room = rig_.room[static_cast<std::size_t>(camera)];
    const auto& electronics = rig_.rig.electronics;
    const auto frame = static_cast<std::uint64_t>(f);
    const auto frames = static_cast<std::uint64_t>(options_.frames);
    Random amplifier(options_.seed, stream), converter(options_.seed, stream);
    amplifier.seek((2 * block * frames + frame) * kDrawsPerFrame);
    converter.seek(((2 * block + 1) * frames + frame) * kDrawsPerFrame);
    const double highest = electronics.highest_code();
    bool full = false;
    for (int k = 0; k < 4; ++k) {
      double m = expected[k] + room.flicker_counts * std::sin(2.0 * pi * rig_.light.flicker_hz * time_s[k] +
                                                              room.flicker_phase_rad);
      if (options_.noise) {
        const double sd = camera::amplifier_noise_counts(electronics, m);
        m += sd * amplifier.gaussian();
        m += electronics.converter_noise_counts * converter.gaussian();
      }
      m = std::clamp(std::nearbyint(m), 0.0, highest);
      full = full || m == highest;
      codes[k] = static_cast<std::int16_t>(m);
    }
    return full;
  }

  const PhysicalRig& rig_;
  const RigScene& scene_;
  const RigRecordingOptions& options_;
  RigRecording& out_;
};

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
  std::vector<std::string> cameras;
  for (const auto& camera : rig.rig.cameras) cameras.push_back(camera.name);
  const TimeBase time{.rate_hz = options.rate_hz, .t0_s = options.t0_s, .frames = options.frames};
  const auto& timing = rig.rig.timing;
  out.counts = data::Counts::zeros(scene.leds, cameras, time, timing.dark_slot);
  out.counts.rig_id = rig.rig.id;
  out.counts.highest_code = static_cast<std::int16_t>(rig.rig.electronics.highest_code());
  const int C = rig.rig.camera_count(), L = static_cast<int>(scene.leds.size());
  for (int c = 0; c < C; ++c)
    for (int k = 0; k < 4; ++k) {
      for (int l = 0; l < L; ++l)
        out.counts.conversion_time_s[static_cast<std::size_t>(4 * (l * C + c) + k)] =
            timing.conversion_offset_s(l, c, k, C);
      if (timing.dark_slot)
        out.counts.dark_time_s[static_cast<std::size_t>(4 * c + k)] = timing.conversion_offset_s(L, c, k, C);
    }
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
    Recorder recorder(rig, scene, options, out);
    for (std::int64_t f = begin; f < end; ++f) {
      recorder.frame(f);
      truth_of_frame(scene, f, out);
    }
  });
  return out;
}

}  // namespace kinemark::simulation
