// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// For tests: where the bodies and markers of a description are, by the definition in data/model_description.h
// and nothing else. Slow and plain, so that the readers have something to be checked against besides model/.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "kinemark/data/model_description.h"

namespace kinemark::io::osim {

inline double amount(const data::AxisDescription& axis, const std::vector<double>& q) {
  const auto at = [&](int idx) { return idx < 0 ? 0.0 : q[static_cast<std::size_t>(idx)]; };
  const double first = axis.function(at(axis.coordinate_idx)).f;
  return axis.second_coordinate_idx < 0 ? first
                                        : first * axis.second_function(at(axis.second_coordinate_idx)).f;
}

inline math::SE3 motion_of(const data::JointDescription& joint, const std::vector<double>& q) {
  math::SE3 motion;
  for (const auto& axis : joint.axes) {
    const Eigen::Vector3d unit = axis.axis.normalized();
    if (axis.is_rotation)
      motion.rotation = motion.rotation * Eigen::AngleAxisd(amount(axis, q), unit).toRotationMatrix();
    else
      motion.translation += amount(axis, q) * unit;
  }
  return motion;
}

/// world_from_body of every body.
inline std::vector<math::SE3> place_bodies(const data::ModelDescription& model,
                                           const std::vector<double>& q) {
  std::vector<math::SE3> world_from(model.bodies.size());
  std::vector<bool> placed(model.bodies.size(), false);
  for (std::size_t round = 0; round < model.bodies.size(); ++round)
    for (const auto& joint : model.joints) {
      const auto child = static_cast<std::size_t>(joint.child_body_idx);
      const bool on_ground = joint.parent_body_idx < 0;
      if (placed[child] || (!on_ground && !placed[static_cast<std::size_t>(joint.parent_body_idx)])) continue;
      const math::SE3 parent =
          on_ground ? math::SE3{} : world_from[static_cast<std::size_t>(joint.parent_body_idx)];
      world_from[child] =
          parent * joint.parent_from_joint * motion_of(joint, q) * joint.child_from_joint.inverse();
      placed[child] = true;
    }
  return world_from;
}

inline Eigen::Vector3d place_point(const std::vector<math::SE3>& world_from, int body,
                                   const Eigen::Vector3d& x) {
  return body < 0 ? x : world_from[static_cast<std::size_t>(body)] * x;
}

/// World positions of all markers, in the model's order.
inline std::vector<Eigen::Vector3d> place_markers(const data::ModelDescription& model,
                                                  const std::vector<double>& q) {
  const auto bodies = place_bodies(model, q);
  std::vector<Eigen::Vector3d> markers;
  for (const auto& marker : model.markers)
    markers.push_back(place_point(bodies, marker.body_idx, marker.x_in_body));
  return markers;
}

inline std::vector<double> default_pose(const data::ModelDescription& model) {
  std::vector<double> q;
  for (const auto& c : model.coordinates) q.push_back(c.default_value);
  return q;
}

}  // namespace kinemark::io::osim
