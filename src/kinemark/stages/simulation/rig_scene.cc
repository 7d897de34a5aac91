// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/rig_scene.h"

#include <cmath>
#include <numbers>

#include "kinemark/core/units.h"
#include "kinemark/math/euler.h"

namespace kinemark::simulation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kTreeBack = 0.533, kTreeSide = 0.310;

Matrix3d about(const Vector3d& axis, double angle_deg) {
  return math::axis_angle(axis, angle_deg * kRadPerDeg);
}

}  // namespace

Matrix3d tree_vertices() {
  const double depth = std::sqrt(kTreeSide * kTreeSide - kTreeBack * kTreeBack / 4.0);
  Matrix3d out;
  out.col(0) << -kTreeBack / 2.0, 0.0, -depth / 3.0;
  out.col(1) << kTreeBack / 2.0, 0.0, -depth / 3.0;
  out.col(2) << 0.0, 0.0, 2.0 * depth / 3.0;
  return out;
}

std::array<double, 3> tree_sides_m() { return {kTreeBack, kTreeSide, kTreeSide}; }

math::SE3 TreePose::world_from_tree() const {
  return {about(Vector3d::UnitY(), yaw_deg) * about(Vector3d::UnitX(), pitch_deg) *
              about(Vector3d::UnitZ(), roll_deg),
          centroid_in_world};
}

Matrix3d TreePose::leds_in_world() const {
  const math::SE3 pose = world_from_tree();
  return (pose.rotation * tree_vertices()).colwise() + pose.translation;
}

const std::array<TreePose, 10>& tree_test_poses() {
  static const std::array<TreePose, 10> poses{{{{0.0, 0.0, 0.0}, 0, 0, 0},
                                               {{0.0, 0.330, 0.0}, 10, 10, 0},
                                               {{0.0, -0.430, 0.060}, -10, -10, 5},
                                               {{0.150, 0.120, 0.150}, 20, 0, 40},
                                               {{-0.150, -0.120, 0.170}, -20, 15, -35},
                                               {{0.0, 0.200, 0.380}, 0, -20, 90},
                                               {{0.0, -0.180, -0.330}, 30, 0, 20},
                                               {{0.178, 0.294, -0.062}, -15, 10, 75},
                                               {{-0.250, 0.230, -0.160}, 15, -25, -80},
                                               {{0.060, 0.0, 0.460}, 25, 30, 60}}};
  return poses;
}

RigScene still_tree(const TreePose& pose, TreeLeds leds) {
  RigScene scene;
  scene.leds = {"back left", "back right", "front"};
  const Vector3d normal =
      leds == TreeLeds::turn_with_it ? Vector3d(pose.world_from_tree().rotation.col(2)) : Vector3d::UnitZ();
  scene.led = [positions = pose.leds_in_world(), normal](int led, double) {
    return LedState{.x_in_world = positions.col(led), .normal = normal};
  };
  return scene;
}

math::SE3 wheel_pose(const WheelOptions& options) {
  return {about(Vector3d::UnitY(), options.rotation_deg) * about(Vector3d::UnitX(), -4.0),
          {0.020, -0.030, -0.040}};
}

RigScene rotating_wheel(const WheelOptions& options) {
  RigScene scene;
  for (int led = 1; led <= options.leds; ++led)
    scene.leds.push_back(options.leds == 1 ? "rim" : "rim " + std::to_string(led));
  scene.led = [options, pose = wheel_pose(options)](int led, double time_s) {
    const double angle = 2.0 * pi * (options.rate_hz * time_s + static_cast<double>(led) / options.leds);
    const Vector3d in_wheel(options.diameter_m / 2.0 * std::cos(angle),
                            options.diameter_m / 2.0 * std::sin(angle), 0.0);
    return LedState{.x_in_world = pose * in_wheel, .normal = pose.rotation.col(2)};
  };
  if (options.glint_share > 0.0)
    scene.reflection = [options](int led, double time_s, const Vector3d& x_in_world) {
      // The mirror catches the eye while the LED's radius stands within 4 degrees of one radian.
      const double revolutions = options.rate_hz * time_s + static_cast<double>(led) / options.leds;
      const double off = std::remainder(2.0 * pi * revolutions - 1.0, 2.0 * pi);
      return Reflection{.position_in_world = x_in_world + Vector3d(0.0, 0.260, 0.030),
                        .share = std::abs(off) < 4.0 * kRadPerDeg ? options.glint_share : 0.0};
    };
  return scene;
}

}  // namespace kinemark::simulation
