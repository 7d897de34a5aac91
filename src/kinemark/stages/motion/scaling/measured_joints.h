// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint centres that a functional method found, as observations of a model's geometry.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/data/model_description.h"
#include "kinemark/data/skeleton.h"

namespace kinemark::motion {

/// Where a joint of the model lies among markers of one of its two bodies. All positions are in axes of the
/// markers' own, which the fit lays over the body.
struct MeasuredJoint {
  std::string joint;         ///< of the model
  bool in_parent = true;     ///< the markers sit on the joint's parent body; false: on its child
  std::vector<int> markers;  ///< indices into the description, 3 or more, not on a line
  Eigen::Matrix3Xd x;        ///< one column a marker, m
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();          ///< m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of the centre, m^2; symmetric, finite
};

/// The joints of a skeleton that are joints of a model.
struct MeasuredJoints {
  std::vector<MeasuredJoint> joints;  ///< one or two for each joint that is used: in parent and in child
  std::vector<std::string> names;     ///< of the model's joints that are used
  std::vector<std::string> left_out;  ///< one sentence for each joint of the skeleton that is not used
};

/// Find the model's joint for each joint of a skeleton: the one between the two bodies that carry most
/// markers of its segments, whichever of them is the parent. Markers are found by name, exactly or behind a
/// prefix.
///
/// A side counts whose segment has three markers or more on that body, not on a line.
///
/// Left out, with the reason: a segment with fewer than two of its markers on one body of the model; a joint
/// of which no side counts; bodies that no joint connects, or one that moves its centre (a knee that slides);
/// a centre without a covariance; a second joint of the skeleton at the same place.
[[nodiscard]] MeasuredJoints match_joints(const data::ModelDescription& model,
                                          const data::Skeleton& skeleton);

}  // namespace kinemark::motion
