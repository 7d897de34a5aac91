// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/animation/joint_tree.h"

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/math/euler.h"

namespace kinemark::io {

std::size_t JointTree::channel_count() const {
  std::size_t n = 0;
  for (const auto& joint : joints) n += joint.channels.size();
  return n;
}

void place_joints(const JointTree& tree, std::span<const double> values, std::span<Eigen::Vector3d> x,
                  std::span<Eigen::Matrix3d> rotation) {
  check(x.size() == tree.joints.size() && rotation.size() == tree.joints.size(),
        "place_joints() needs room for every joint");
  std::size_t next = 0;
  for (std::size_t j = 0; j < tree.joints.size(); ++j) {
    const JointNode& joint = tree.joints[j];
    Eigen::Vector3d moved = joint.stands_for_offset ? Eigen::Vector3d::Zero() : joint.offset;
    Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
    for (const JointChannel& channel : joint.channels) {
      check(next < values.size(), "place_joints() needs a number for every channel");
      const double value = values[next++];
      if (!channel.is_rotation) {
        moved(channel.axis) += value;
        continue;
      }
      const Eigen::Matrix3d turn = math::axis_angle(Eigen::Vector3d::Unit(channel.axis), value);
      turned = joint.about_fixed_axes ? Eigen::Matrix3d(turn * turned) : Eigen::Matrix3d(turned * turn);
    }
    rotation[j] = joint.axes * turned * joint.axes.transpose();
    x[j] = moved;
    if (joint.parent < 0) continue;
    x[j] = x[at(joint.parent)] + rotation[at(joint.parent)] * moved;
    rotation[j] = rotation[at(joint.parent)] * rotation[j];
  }
}

}  // namespace kinemark::io
