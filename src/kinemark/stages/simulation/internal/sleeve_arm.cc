// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/sleeve_arm.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kinemark/core/random.h"
#include "kinemark/stages/simulation/internal/limb_build.h"

namespace kinemark::simulation::internal {
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
ArmPose pose_arm(const Vector3d& goal, double swivel, double roll) {
  const double far = std::clamp(goal.norm(), kNearest_m, kUpperArm_m + kForearm_m - kStraight_m);
  const Vector3d n = goal.normalized();
  const double along = (kUpperArm_m * kUpperArm_m - kForearm_m * kForearm_m + far * far) / (2.0 * far);
  const double beside = std::sqrt(std::max(kUpperArm_m * kUpperArm_m - along * along, 0.0));
  const Vector3d down = (-Vector3d::UnitZ() + n.z() * n).normalized();
  ArmPose out;
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

}  // namespace

ArmMotion::ArmMotion(const SleeveOptions& options)
    : rate_hz_(options.rate_hz), path_(options.seed, options.rate_hz) {
  // A stream of their own beside the path's.
  Random phases(options.seed + 1, static_cast<std::uint64_t>(LimbStream::sight) + 1);
  phase_a_ = phases.uniform(0.0, 2.0 * pi);
  phase_b_ = phases.uniform(0.0, 2.0 * pi);
}

ArmPose ArmMotion::next() {
  const double t = TimeBase{rate_hz_, 0.0, frame_ + 1}.time_s(frame_);
  ++frame_;
  const double swivel =
      0.5 + 0.35 * std::sin(2.0 * pi * 0.31 * t + phase_a_) + 0.15 * std::sin(2.0 * pi * 0.83 * t + phase_b_);
  return pose_arm(path_.next(), swivel, 0.4 * std::sin(2.0 * pi * 0.4 * t + 1.0));
}

std::array<Eigen::Matrix3Xd, 2> sleeve_leds(const SleeveOptions& options) {
  const int n = options.leds_per_segment;
  std::array<Eigen::Matrix3Xd, 2> out = {led_positions(options, kUpperArm_m), Eigen::Matrix3Xd()};
  out[1].resize(3, n + (options.tip ? 1 : 0));
  out[1].leftCols(n) = led_positions(options, kForearm_m);
  if (options.tip) out[1].col(n) << 0.0, 0.0, kForearm_m;
  return out;
}

LedInWorld led_in_world(const SleeveOptions& options, const std::array<Eigen::Matrix3Xd, 2>& leds,
                        const ArmPose& pose, int led, const Vector3d& slide) {
  const int n = options.leds_per_segment;
  const bool forearm = led >= n, tip = led == 2 * n;
  const Vector3d position = leds[forearm ? 1 : 0].col(forearm ? led - n : led);
  const Matrix3d& rotation = forearm ? pose.world_from_forearm : pose.world_from_upper_arm;
  LedInWorld out;
  out.x = (forearm ? pose.elbow : Vector3d(Vector3d::Zero())) + rotation * (position + slide);
  out.normal = tip ? Vector3d(rotation.col(2))
                   : Vector3d(rotation * Vector3d(position.x(), position.y(), 0.0).stableNormalized());
  return out;
}

}  // namespace kinemark::simulation::internal
