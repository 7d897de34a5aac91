// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A skeleton as files of animators describe it: joints that hang from one another, each moved by a few
// numbers a frame.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kinemark::io {

/// What one number of a frame does to its joint.
struct JointChannel {
  bool is_rotation = true;  ///< false: moves along the axis
  int axis = 0;             ///< 0 to 2: x, y, z
};

/// One joint, or a point fixed to one.
struct JointNode {
  std::string name;                                    ///< as the file has it
  int parent = -1;                                     ///< smaller than its own index; -1: the laboratory
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();    ///< in the parent's axes, in units of the file
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< those that the channels turn about, in the joint's
  std::vector<JointChannel> channels;                  ///< in the order of the file
  bool about_fixed_axes = false;   ///< each rotation after the ones before it, about axes that stay
  bool stands_for_offset = false;  ///< what moves it is instead of its offset, not beside
  bool is_point = true;            ///< false: nothing stands where it is
};

/// Joints, parents before their children.
struct JointTree {
  std::vector<JointNode> joints;  ///< J

  [[nodiscard]] std::size_t channel_count() const;  ///< numbers in a frame, of all joints in their order
};

/// Where the joints are.
/// @param values   of one frame: channel_count() numbers, rad and units of the file
/// @param x        J, gets the positions, in units of the file
/// @param rotation J, scratch: gets world_from_joint
/// A joint's rotation is axes * R1 * R2 * R3 * axes^T by its channels in their order, axes * R3 * R2 * R1 *
/// axes^T about fixed axes. O(J), allocates nothing.
void place_joints(const JointTree& tree, std::span<const double> values, std::span<Eigen::Vector3d> x,
                  std::span<Eigen::Matrix3d> rotation);

}  // namespace kinemark::io
