// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include "kinemark/stages/simulation/internal/limb_build.h"
#include "kinemark/stages/simulation/internal/sleeve_arm.h"
#include "kinemark/stages/simulation/internal/sleeve_sight.h"
#include "kinemark/stages/simulation/internal/sleeve_skin.h"
#include "kinemark/stages/simulation/limb.h"

namespace kinemark::simulation {
namespace {

using Eigen::Vector3d;

std::vector<internal::ArmPose> move_arm(const SleeveOptions& options) {
  internal::ArmMotion motion(options);
  std::vector<internal::ArmPose> out;
  for (std::int64_t f = 0; f < options.frames(); ++f) out.push_back(motion.next());
  return out;
}

}  // namespace

SleeveOptions SleeveOptions::hard() {
  SleeveOptions out;
  out.sight_cosine = 0.35;
  out.sight_cameras = 3;
  out.mouth_loss = 0.9;
  out.missing = 0.2;
  return out;
}

std::int64_t SleeveOptions::frames() const { return std::llround(duration_s * rate_hz); }

Status SleeveOptions::check() const {
  using internal::in_range;
  for (const auto& status :
       {in_range("duration_s", duration_s, 1e-6, 1e9), in_range("rate_hz", rate_hz, 1e-3, 1e6),
        in_range("duration_s x rate_hz", duration_s * rate_hz, 0.5, internal::kMostLimbFrames),
        in_range("leds_per_segment", leds_per_segment, 2.0, 32.0),
        in_range("frames x LEDs", duration_s * rate_hz * 2.0 * leds_per_segment, 1.0, 1e8),
        in_range("radius_m", radius_m, 1e-4, 1.0), in_range("noise_sd_m", noise_sd_m, 0.0, 1.0),
        in_range("sight_cosine", sight_cosine, -1.0, 1.0), in_range("sight_cameras", sight_cameras, 1.0, 6.0),
        in_range("mouth_loss", mouth_loss, 0.0, 1.0), in_range("missing", missing, 0.0, 0.95),
        in_range("skin_m", skin_m, 0.0, 1.0)})
    if (!status) return status;
  return {};
}

Result<LimbRecording> simulate_sleeve(const SleeveOptions& options) {
  if (auto status = options.check(); !status) return std::unexpected(status.error());
  const int n = options.leds_per_segment;
  const TimeBase time{options.rate_hz, 0.0, options.frames()};
  LimbRecording out =
      internal::empty_limb({"upper_arm", "forearm"}, {"elbow"}, {"u", "f"}, n, time,
                           options.tip ? std::vector<std::string>{"w0"} : std::vector<std::string>{});
  out.origin_name = "shoulder";
  out.end_name = "wrist";
  out.layout.ends.push_back({.name = out.origin_name, .segment = "upper_arm"});
  if (options.tip) out.layout.ends.push_back({.name = out.end_name, .segment = "forearm", .marker = 2 * n});
  const auto leds = internal::sleeve_leds(options);
  out.x_in_segment = {leds[0], leds[1]};

  const auto poses = move_arm(options);
  const internal::SleeveSkin skin(options, poses, out.x_in_segment);
  internal::SleeveSight sight(options);
  std::vector<std::uint8_t> seen(out.markers.state.size(), 1);
  for (std::int64_t f = 0; f < time.frames; ++f) {
    const internal::ArmPose& pose = poses[static_cast<std::size_t>(f)];
    sight.begin_frame(pose.wrist);
    for (int led = 0; led < 2 * n + (options.tip ? 1 : 0); ++led) {
      const auto [x, normal] =
          internal::led_in_world(options, leds, pose, led, skin.slide(static_cast<std::size_t>(f), led));
      const std::size_t at = out.markers.index(f, led);
      Eigen::Map<Vector3d>(out.x_true.data() + 3 * at) = x;
      if (options.line_of_sight && !sight.sees(led, x, normal)) seen[at] = 0;
    }
    Eigen::Map<Vector3d>(out.centre_in_world.data() + 3 * f) = pose.elbow;
    Eigen::Map<Vector3d>(out.end_in_world.data() + 3 * f) = pose.wrist;
  }
  internal::record_limb(out, options.noise_sd_m, options.missing, options.seed);
  for (std::int64_t f = 0; f < time.frames; ++f)
    for (std::int64_t led = 0; led < out.markers.markers(); ++led)
      if (seen[out.markers.index(f, led)] == 0) out.markers.set_missing(f, led);
  return out;
}

}  // namespace kinemark::simulation
