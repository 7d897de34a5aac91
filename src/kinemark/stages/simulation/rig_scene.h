// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Scenes of LEDs before the rig: the position of each LED at any time, and what occludes or mirrors it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kinemark/math/se3.h"
#include "kinemark/stages/simulation/rig_physics.h"

namespace kinemark::simulation {

/// Reflection of an LED at one instant; share 0: none.
struct Reflection {
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();  ///< m, apparent position of the light
  double share = 0.0;                                           ///< of the LED's direct light
};

/// Frames in which an LED is occluded from a camera.
struct Occlusion {
  int led = 0;                                   ///< index into RigScene::leds
  int camera = -1;                               ///< -1: all of them
  std::int64_t first_frame = 0, last_frame = 0;  ///< both included
};

/// LEDs that move, what reflects them and what hides them.
struct RigScene {
  std::vector<std::string> leds;  ///< names
  /// State of an LED at a time (s); called from several threads at once.
  std::function<LedState(int led, double time_s)> led;
  /// Mirrors; may be empty.
  std::function<Reflection(int led, double time_s, const Eigen::Vector3d& x_in_world)> reflection;
  std::vector<Occlusion> occlusions;  ///< in any order
};

/// The orientation tree: three LEDs, sides 533, 310 and 310 mm; columns are its vertices, m: back left, back
/// right, front; the plane is level.
[[nodiscard]] Eigen::Matrix3d tree_vertices();
/// Distances of its vertices 0-1, 0-2 and 1-2, m.
[[nodiscard]] std::array<double, 3> tree_sides_m();

/// Pose of the tree: centroid (m in world), then turned about X, Y and Z: Ry(yaw) Rx(pitch) Rz(roll).
struct TreePose {
  Eigen::Vector3d centroid_in_world = Eigen::Vector3d::Zero();  ///< m
  double yaw_deg = 0.0, pitch_deg = 0.0, roll_deg = 0.0;        ///< turns about Y, X and Z
  /// Tree to world, m.
  [[nodiscard]] math::SE3 world_from_tree() const;
  /// Columns are the LEDs, m in world.
  [[nodiscard]] Eigen::Matrix3d leds_in_world() const;
};

/// Ten poses of the tree that both cameras see, spread through the volume.
[[nodiscard]] const std::array<TreePose, 10>& tree_test_poses();

/// Where the tree's LEDs shine.
enum class TreeLeds : std::uint8_t {
  face_the_cameras,  ///< along the world's Z, however the tree is turned
  turn_with_it,      ///< along Z of the tree
};
/// Still LEDs "back left", "back right", "front".
[[nodiscard]] RigScene still_tree(const TreePose& pose, TreeLeds leds = TreeLeds::face_the_cameras);

/// Options of the turning wheel of the 1986 study.
struct WheelOptions {
  double rotation_deg = 8.0;  ///< about the vertical; the study uses 8 and 35. Then tilted by -4 deg
  double diameter_m = 0.392;  ///< of the circle on which its LEDs sit, > 0
  double rate_hz = 1.5;       ///< revolutions per second
  double glint_share = 0.0;   ///< 0.04: the frame mirrors that share during 8 degrees of each turn
  int leds = 1;               ///< 1 to 8, evenly along the rim
};

/// One LED, "rim", or several, "rim 1" and so on, on a wheel about (20, -30, -40) mm.
[[nodiscard]] RigScene rotating_wheel(const WheelOptions& options = {});

/// world_from_wheel: the wheel lies in the plane of X and Y about its axis Z.
[[nodiscard]] math::SE3 wheel_pose(const WheelOptions& options = {});

/// LEDs on "shoulder", "elbow", "wrist" and "hand" of a signer who signs LOOK-AT[Continuative] once in
/// 0.719 s: the hand runs round an ellipse of 170 by 80 mm with an uneven rhythm, 2.7 m/s at its fastest and
/// 0.5 at its slowest. Bones of 310, 280 and 80 mm keep their lengths. With the three occlusions of the
/// study: hand in camera B, frames 120 to 131; wrist in A, 200 to 209; elbow in both, 300 to 306.
[[nodiscard]] RigScene signing_arm();

}  // namespace kinemark::simulation
