// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/stages/simulation/internal/limb_build.h"
#include "kinemark/stages/simulation/internal/reach_path.h"
#include "kinemark/stages/simulation/internal/sleeve_sight.h"
#include "kinemark/stages/simulation/internal/sleeve_skin.h"
#include "kinemark/stages/simulation/limb.h"

namespace kinemark::simulation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kUpperArm_m = 0.150, kForearm_m = 0.160;
constexpr double kNearest_m = 0.040, kStraight_m = 0.008;  // wrist from shoulder; reach left when straightest

Matrix3d axes(const Vector3d& along, const Vector3d& hinge, double roll) {
  const Vector3d across = along.cross(hinge);
  Matrix3d out;
  out << std::cos(roll) * hinge + std::sin(roll) * across, std::cos(roll) * across - std::sin(roll) * hinge,
      along;
  return out;
}

/// The elbow lies on the circle that both lengths leave open, `swivel` rad from hanging straight down.
internal::ArmPose pose_arm(const Vector3d& goal, double swivel, double roll) {
  const double far = std::clamp(goal.norm(), kNearest_m, kUpperArm_m + kForearm_m - kStraight_m);
  const Vector3d n = goal.normalized();
  const double along = (kUpperArm_m * kUpperArm_m - kForearm_m * kForearm_m + far * far) / (2.0 * far);
  const double beside = std::sqrt(std::max(kUpperArm_m * kUpperArm_m - along * along, 0.0));
  const Vector3d down = (-Vector3d::UnitZ() + n.z() * n).normalized();
  internal::ArmPose out;
  out.wrist = far * n;
  out.elbow = along * n + beside * (std::cos(swivel) * down + std::sin(swivel) * n.cross(down));
  const Vector3d forearm = out.wrist - out.elbow;
  const Vector3d hinge = out.elbow.cross(forearm).normalized();
  out.world_from_upper_arm = axes(out.elbow / kUpperArm_m, hinge, 0.0);
  out.world_from_forearm = axes(forearm / kForearm_m, hinge, roll);
  return out;
}

/// Three turns about the limb over its LEDs, or the next number of turns that shares no factor with theirs:
/// neighbours face different directions, no two are above each other, and they never lie in one plane.
Eigen::Matrix3Xd led_positions(const SleeveOptions& options, double length_m) {
  const int n = options.leds_per_segment;
  int revolutions = n > 3 ? 3 : 1;
  while (std::gcd(revolutions, n) != 1) ++revolutions;
  Eigen::Matrix3Xd out(3, n);
  for (int k = 0; k < n; ++k) {
    const double angle = 2.0 * pi * k * revolutions / n;
    out.col(k) << options.radius_m * std::cos(angle), options.radius_m * std::sin(angle),
        length_m * (k + 1) / (n + 1);
  }
  return out;
}

/// The arm's poses, frame by frame.
std::vector<internal::ArmPose> move_arm(const SleeveOptions& options, const TimeBase& time) {
  internal::ReachPath path(options.seed, options.rate_hz);
  // Phases of the slow swivel about the line from shoulder to wrist; a stream of their own beside the path's.
  Random phases(options.seed + 1, static_cast<std::uint64_t>(internal::LimbStream::sight) + 1);
  const double phase_a = phases.uniform(0.0, 2.0 * pi);
  const double phase_b = phases.uniform(0.0, 2.0 * pi);
  std::vector<internal::ArmPose> out;
  for (std::int64_t f = 0; f < time.frames; ++f) {
    const double t = time.time_s(f);
    const double swivel =
        0.5 + 0.35 * std::sin(2.0 * pi * 0.31 * t + phase_a) + 0.15 * std::sin(2.0 * pi * 0.83 * t + phase_b);
    out.push_back(pose_arm(path.next(), swivel, 0.4 * std::sin(2.0 * pi * 0.4 * t + 1.0)));
  }
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
  out.x_in_segment[0] = led_positions(options, kUpperArm_m);
  out.x_in_segment[1].leftCols(n) = led_positions(options, kForearm_m);
  if (options.tip) out.x_in_segment[1].col(n) << 0.0, 0.0, kForearm_m;

  const auto poses = move_arm(options, time);
  const internal::SleeveSkin skin(options, poses, out.x_in_segment);
  internal::SleeveSight sight(options);
  std::vector<std::uint8_t> seen(out.markers.state.size(), 1);
  for (std::int64_t f = 0; f < time.frames; ++f) {
    const internal::ArmPose& pose = poses[static_cast<std::size_t>(f)];
    sight.begin_frame(pose.wrist);
    for (int led = 0; led < 2 * n + (options.tip ? 1 : 0); ++led) {
      const bool forearm = led >= n, tip = led == 2 * n;
      const Vector3d position = out.x_in_segment[forearm ? 1 : 0].col(forearm ? led - n : led);
      const Matrix3d& rotation = forearm ? pose.world_from_forearm : pose.world_from_upper_arm;
      const Vector3d x = (forearm ? pose.elbow : Vector3d(Vector3d::Zero())) +
                         rotation * (position + skin.slide(static_cast<std::size_t>(f), led));
      const Vector3d normal =
          tip ? Vector3d(rotation.col(2))
              : Vector3d(rotation * Vector3d(position.x(), position.y(), 0.0).stableNormalized());
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
