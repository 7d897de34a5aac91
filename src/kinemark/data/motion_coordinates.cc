// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/motion_coordinates.h"

#include <algorithm>
#include <cmath>

namespace kinemark::data {
namespace {

/// The axis moves by +-q + constant, as OpenSim's LinearFunction of slope 1 or -1 does.
bool moves_by_coordinate_itself(const AxisDescription& axis) {
  const auto& f = axis.function;
  return axis.second_coordinate_idx < 0 && f.is_linear() && f.factor() == 1.0 && std::abs(f.slope()) == 1.0;
}

}  // namespace

bool keeps_radians(const ModelDescription& model, int coordinate_idx) {
  bool moves = false;
  for (const auto& joint : model.joints)
    for (const auto& axis : joint.axes) {
      if (axis.coordinate_idx != coordinate_idx && axis.second_coordinate_idx != coordinate_idx) continue;
      if (joint.type != "CustomJoint" || moves_by_coordinate_itself(axis)) return false;
      moves = true;
    }
  return moves;
}

void set_coordinates(const ModelDescription& model, JointMotion& motion) {
  motion.coordinates.clear();
  motion.is_rotation.clear();
  motion.keeps_radians.clear();
  for (int c = 0; c < static_cast<int>(model.coordinates.size()); ++c) {
    const auto& coordinate = model.coordinates[static_cast<std::size_t>(c)];
    motion.coordinates.push_back(coordinate.name);
    motion.is_rotation.push_back(coordinate.is_rotation);
    motion.keeps_radians.push_back(keeps_radians(model, c));
  }
}

}  // namespace kinemark::data
