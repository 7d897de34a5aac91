// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/rig_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/camera/noise.h"
#include "kinemark/core/random.h"

namespace kinemark::simulation::internal {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using std::numbers::pi;

constexpr std::uint64_t kDrawsPerFrame = 8;  ///< four Gaussians of two uniforms each
constexpr std::uint64_t kDarkStream = std::uint64_t{1} << 32;

}  // namespace

data::Counts layout_of(const PhysicalRig& rig, const std::vector<std::string>& leds, const TimeBase& time) {
  std::vector<std::string> cameras;
  for (const auto& camera : rig.rig.cameras) cameras.push_back(camera.name);
  const auto& timing = rig.rig.timing;
  auto out = data::Counts::zeros(leds, cameras, time, timing.dark_slot);
  out.rig_id = rig.rig.id;
  out.highest_code = static_cast<std::int16_t>(rig.rig.electronics.highest_code());
  const int C = rig.rig.camera_count(), L = static_cast<int>(leds.size());
  for (int c = 0; c < C; ++c)
    for (int k = 0; k < 4; ++k) {
      for (int l = 0; l < L; ++l)
        out.conversion_time_s[static_cast<std::size_t>(4 * (l * C + c) + k)] =
            timing.conversion_offset_s(l, c, k, C);
      if (timing.dark_slot)
        out.dark_time_s[static_cast<std::size_t>(4 * c + k)] = timing.conversion_offset_s(L, c, k, C);
    }
  return out;
}

void FrameConverter::convert(std::int64_t f, const FramePlace& out) const {
  for (int led = 0; led < leds(); ++led)
    for (int camera = 0; camera < cameras(); ++camera) observe(f, led, camera, out);
  if (!layout_.has_dark_slot()) return;
  for (int camera = 0; camera < cameras(); ++camera) dark(f, camera, out);
}

double FrameConverter::intensity(int led) const {
  return options_.intensity.empty() ? 1.0 : options_.intensity[static_cast<std::size_t>(led)];
}

bool FrameConverter::occluded(std::int64_t f, int led, int camera) const {
  return std::ranges::any_of(scene_.occlusions, [&](const Occlusion& o) {
    return o.led == led && (o.camera < 0 || o.camera == camera) && f >= o.first_frame && f <= o.last_frame;
  });
}

Vector3d FrameConverter::behind(int camera) const {
  const auto& pose = rig_.rig.cameras[static_cast<std::size_t>(camera)].cam_from_world;
  return pose.inverse() * Vector3d(0.0, 0.0, -1.0);
}

void FrameConverter::observe(std::int64_t f, int led, int camera, const FramePlace& out) const {
  const auto offsets = layout_.offset_s(led, camera);
  const bool blocked = occluded(f, led, camera);
  std::uint8_t why = blocked ? kHiddenOccluded : 0;
  Vector4d expected, time_s;
  for (int k = 0; k < 4; ++k) {
    time_s[k] = layout_.time.time_s(f) + offsets[k];
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
  const auto block = static_cast<std::uint64_t>(led * cameras() + camera);
  const bool full = digitize(expected, time_s, camera, options_.stream, block, f, out.counts + 4 * block);
  if (full) out.flags[block] |= data::kCountSaturated;
  if (out.hidden != nullptr) out.hidden[block] = why;
}

void FrameConverter::dark(std::int64_t f, int camera, const FramePlace& out) const {
  const auto offsets = layout_.dark_offset_s(camera);
  const Vector4d time_s = offsets.array() + layout_.time.time_s(f);
  digitize(rig_.rig.cameras[static_cast<std::size_t>(camera)].detector.offset_counts, time_s, camera,
           options_.stream + kDarkStream, static_cast<std::uint64_t>(camera), f, out.dark + 4 * camera);
}

/// Flicker, noise and the converter; true when a channel is at its highest code.
bool FrameConverter::digitize(Vector4d expected, const Vector4d& time_s, int camera, std::uint64_t stream,
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

}  // namespace kinemark::simulation::internal
