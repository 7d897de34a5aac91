// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The contents of a model file, in SI units: bodies, joints as chains of primitive motions, coordinates,
// couplings, loop constraints and markers. model::Model compiles it for computing.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/math/scalar_function.h"
#include "kinemark/math/se3.h"

namespace kinemark::data {

/// Body index of the ground.
inline constexpr int kGround = -1;

struct BodyDescription {
  std::string name;
  double mass = 0.0;                                            ///< kg, >= 0
  Eigen::Vector3d com_in_body = Eigen::Vector3d::Zero();        ///< m
  Eigen::Matrix3d inertia_about_com = Eigen::Matrix3d::Zero();  ///< kg m^2, body axes
};

/// One generalised coordinate. rad or m.
struct CoordinateDescription {
  std::string name;
  bool is_rotation = true;  ///< false: translation, m
  double default_value = 0.0;
  double range_min = -1e30;  ///< limits; meant as such only when clamped
  double range_max = 1e30;
  bool clamped = false;
  bool locked = false;
};

/// One primitive motion of a joint: a rotation about or a translation along an axis by
///   f(q[coordinate])  or  f(q[coordinate]) * g(q[second_coordinate]).
struct AxisDescription {
  bool is_rotation = true;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< need not be of unit length, must not be zero
  int coordinate_idx = -1;                          ///< -1: constant f(0)
  math::ScalarFunction function;
  int second_coordinate_idx = -1;  ///< -1: no second factor
  math::ScalarFunction second_function;
};

/// A joint defines the pose of the child body: world_from_child = world_from_parent * parent_from_joint *
/// motion * child_from_joint^-1.
///
/// motion = translation by all translation axes, taken in the joint frame of the parent, then the rotations,
/// body-fixed, in the order listed (OpenSim's SpatialTransform).
struct JointDescription {
  std::string name;
  std::string type;  ///< the file's word: "CustomJoint", "PinJoint", "ScapulothoracicJoint", ...
  int parent_body_idx = kGround;
  int child_body_idx = 0;
  math::SE3 parent_from_joint;
  math::SE3 child_from_joint;
  std::vector<AxisDescription> axes;
  /// Numbers that a file needs besides the axes to name the type again. EllipsoidJoint: radii x y z;
  /// ScapulothoracicJoint: radii x y z, origin x y and direction of the winging axis. Metres, rad; the axes
  /// rule.
  std::vector<double> parameters;
};

/// q[dependent] = function(q[independent]).
struct CouplingDescription {
  std::string name;
  int dependent_idx = 0;
  int independent_idx = 0;
  math::ScalarFunction function;
};

/// A point of one body that must lie on a point of another (closed loop).
struct PointConstraintDescription {
  std::string name;
  int body_a_idx = kGround;
  int body_b_idx = kGround;
  Eigen::Vector3d point_in_a = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d point_in_b = Eigen::Vector3d::Zero();  ///< m
};

struct MarkerDescription {
  std::string name;
  int body_idx = kGround;
  Eigen::Vector3d x_in_body = Eigen::Vector3d::Zero();  ///< m
};

struct ModelDescription {
  std::string name;
  std::string credits;
  Eigen::Vector3d gravity{0.0, -9.80665, 0.0};     ///< m/s^2
  std::vector<BodyDescription> bodies;             ///< ground is not among them
  std::vector<JointDescription> joints;            ///< one per body, any order
  std::vector<CoordinateDescription> coordinates;  ///< in the order of the file
  std::vector<CouplingDescription> couplings;
  std::vector<PointConstraintDescription> point_constraints;
  std::vector<MarkerDescription> markers;
  std::vector<std::string> warnings;  ///< what was read but is not used, one sentence each

  [[nodiscard]] int find_body(std::string_view name) const;        ///< index, or -2 (-1 is "ground")
  [[nodiscard]] int find_coordinate(std::string_view name) const;  ///< index, or -1
  [[nodiscard]] int find_marker(std::string_view name) const;      ///< index, or -1

  /// Indices are in range, names unique, every body hangs from the ground by exactly one joint without a
  /// cycle, axes are not zero, masses not negative, numbers finite, couplings without a cycle.
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data
