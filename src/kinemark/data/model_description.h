// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The contents of a model file, in SI units: bodies, joints as chains of primitive motions, coordinates,
// couplings, loop constraints and markers. model::Model compiles it for computing.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/math/scalar_function.h"
#include "kinemark/math/se3.h"

namespace kinemark::data {

/// Body index of the ground.
inline constexpr int kGround = -1;

/// One rigid body.
struct BodyDescription {
  std::string name;                                             ///< unique among the bodies
  double mass = 0.0;                                            ///< kg, >= 0
  Eigen::Vector3d com_in_body = Eigen::Vector3d::Zero();        ///< m
  Eigen::Matrix3d inertia_about_com = Eigen::Matrix3d::Zero();  ///< kg m^2, body axes
};

/// One generalised coordinate. rad or m.
struct CoordinateDescription {
  std::string name;            ///< unique among the coordinates
  bool is_rotation = true;     ///< false: translation, m
  double default_value = 0.0;  ///< rad or m
  double range_min = -1e30;    ///< limits; meant as such only when clamped
  double range_max = 1e30;     ///< rad or m
  bool clamped = false;        ///< whether the limits hold
  bool locked = false;         ///< whether it stays at default_value
  /// Its value at a time in s, rad or m, where a function of time gives it instead of the markers; a locked
  /// one has none.
  std::optional<math::ScalarFunction> prescribed = std::nullopt;

  /// Whether no marker moves it: locked or prescribed.
  [[nodiscard]] bool held() const { return locked || prescribed.has_value(); }
};

/// One primitive motion of a joint: a rotation about or a translation along an axis by
///   f(q[coordinate])  or  f(q[coordinate]) * g(q[second_coordinate]).
struct AxisDescription {
  bool is_rotation = true;                          ///< false: translation
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< need not be of unit length, must not be zero
  int coordinate_idx = -1;                          ///< -1: constant f(0)
  math::ScalarFunction function;                    ///< f, of rad or m, to rad or m
  int second_coordinate_idx = -1;                   ///< -1: no second factor
  math::ScalarFunction second_function;             ///< g, dimensionless
};

/// A joint defines the pose of the child body: world_from_child = world_from_parent * parent_from_joint *
/// motion * child_from_joint^-1.
///
/// motion = translation by all translation axes, taken in the joint frame of the parent, then the rotations,
/// body-fixed, in the order listed (OpenSim's SpatialTransform).
struct JointDescription {
  std::string name;               ///< unique among the joints
  std::string type;               ///< the file's word: "CustomJoint", "PinJoint", "ScapulothoracicJoint", ...
  int parent_body_idx = kGround;  ///< kGround: hangs from the ground
  int child_body_idx = 0;         ///< the body that it carries
  math::SE3 parent_from_joint;    ///< joint frame in the parent body, m
  math::SE3 child_from_joint;     ///< joint frame in the child body, m
  std::vector<AxisDescription> axes;  ///< translations and rotations that move the child
  /// Numbers that a file needs besides the axes to name the type again. EllipsoidJoint: radii x y z;
  /// ScapulothoracicJoint: radii x y z, origin x y and direction of the winging axis. Metres, rad; the axes
  /// rule.
  std::vector<double> parameters;
};

/// q[dependent] = function(q[independent]).
struct CouplingDescription {
  std::string name;               ///< unique among the couplings
  int dependent_idx = 0;          ///< index of the coordinate that follows
  int independent_idx = 0;        ///< index of the coordinate that leads
  math::ScalarFunction function;  ///< rad or m in and out
};

/// A point of one body that must lie on a point of another (closed loop).
struct PointConstraintDescription {
  std::string name;                                      ///< unique among the constraints
  int body_a_idx = kGround;                              ///< kGround: fixed in the world
  int body_b_idx = kGround;                              ///< kGround: fixed in the world
  Eigen::Vector3d point_in_a = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d point_in_b = Eigen::Vector3d::Zero();  ///< m
};

/// A marker on a body.
struct MarkerDescription {
  std::string name;                                     ///< unique among the markers
  int body_idx = kGround;                               ///< kGround: fixed in the world
  Eigen::Vector3d x_in_body = Eigen::Vector3d::Zero();  ///< m
};

/// A body model as a file describes it; model::Model compiles it for computing.
struct ModelDescription {
  std::string name;                                           ///< of the model
  std::string credits;                                        ///< who made it, as the file says; may be empty
  Eigen::Vector3d gravity{0.0, -9.80665, 0.0};                ///< m/s^2
  std::vector<BodyDescription> bodies;                        ///< ground is not among them
  std::vector<JointDescription> joints;                       ///< one per body, any order
  std::vector<CoordinateDescription> coordinates;             ///< in the order of the file
  std::vector<CouplingDescription> couplings;                 ///< coordinates that follow others
  std::vector<PointConstraintDescription> point_constraints;  ///< closed loops
  std::vector<MarkerDescription> markers;                     ///< in the order of the file
  std::vector<std::string> warnings;  ///< what was read but is not used, one sentence each

  [[nodiscard]] int find_body(std::string_view name) const;        ///< index, or -2 (-1 is "ground")
  [[nodiscard]] int find_coordinate(std::string_view name) const;  ///< index, or -1
  [[nodiscard]] int find_marker(std::string_view name) const;      ///< index, or -1

  /// Indices are in range, names unique, every body hangs from the ground by exactly one joint without a
  /// cycle, axes are not zero, masses not negative, numbers finite, couplings without a cycle.
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data
