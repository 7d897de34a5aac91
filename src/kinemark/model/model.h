// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A body tree compiled for computing.
//
// Three vectors describe a posture and its motion:
//   q  n coordinates, as the model file names them (rad, m): what goes in and comes out
//   x  the internal state: one number per independent coordinate, but seven per free joint (position, unit
//   quaternion) v  nv speeds: one per independent coordinate, six per free joint (velocity of the joint
//   origin along the axes of
//      the parent's joint frame, then angular velocity along the axes of the child's joint frame)
// Coupled coordinates are functions of independent ones and own no speed. A joint to the ground with all
// translations and rotations is a free joint: its Euler angles are computed on output only, so that no
// posture is singular.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/math/scalar_function.h"
#include "kinemark/math/se3.h"

namespace kinemark::model {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Motion or force field about the world origin: angular part, then linear part.
struct Spatial {
  /// rad/s or N m.
  Vector3d w = Vector3d::Zero();
  /// m/s or N.
  Vector3d v = Vector3d::Zero();
};

/// Options of Model::compile().
struct CompileOptions {
  bool free_roots =
      true;  ///< false: keep the file's Euler angles as states (singular where the middle angle is 90 deg)
};

/// A body tree compiled for computing: constant, shared by threads, each with a Workspace of its own.
class Model {
 public:
  /// How one coordinate of the file is computed from the state.
  struct Coordinate {
    int state_idx = -1;             ///< index in x; -1 when it belongs to a free joint or is coupled
    int speed_idx = -1;             ///< index in v; -1 likewise
    int free_joint = -1;            ///< index into free_joints(), or -1
    int free_axis = -1;             ///< 0-2 rotation, 3-5 translation, within the free joint
    int source = -1;                ///< the coordinate that this one is coupled to, or -1
    math::ScalarFunction coupling;  ///< value of this coordinate by that of `source`
  };

  /// One primitive motion: value f(q[coordinate]) g(q[second]).
  struct Primitive {
    bool is_rotation = true;               ///< false: translation
    Vector3d axis = Vector3d::UnitX();     ///< unit length
    int principal = -1;                    ///< 0, 1, 2 when the axis is +-X, +-Y, +-Z
    int coordinate = -1;                   ///< index into coordinates(), or -1: constant
    math::ScalarFunction function;         ///< f, of rad or m, to rad or m
    bool is_identity = false;              ///< f(q) = q
    int second_coordinate = -1;            ///< index into coordinates(), or -1: no second factor
    math::ScalarFunction second_function;  ///< g, dimensionless
    int column = -1;                       ///< column driven by `coordinate`'s speed, or -1
    int second_column = -1;                ///< column driven by `second_coordinate`'s speed, or -1
  };

  /// One speed's motion field within one joint: all primitives of the joint that this speed drives, added up.
  struct Column {
    int body = -1;   ///< index into bodies()
    int speed = -1;  ///< index into v
  };

  /// One rigid body and the joint that carries it.
  struct Body {
    int parent = data::kGround;                    ///< always smaller than the body's own index
    int description_idx = -1;                      ///< index in the description; -1 never occurs
    math::SE3 parent_from_joint, body_from_joint;  ///< m
    /// no rotation, so that products are left out
    bool plain_parent_rotation = true, plain_child_rotation = true;
    int first_primitive = 0, last_primitive = 0;    ///< [first, last); translations first
    int first_column = 0, last_column = 0;          ///< [first, last)
    int free_joint = -1;                            ///< index into free_joints(), or -1
    double mass = 0.0;                              ///< kg
    Vector3d com_in_body = Vector3d::Zero();        ///< m
    Matrix3d inertia_about_com = Matrix3d::Zero();  ///< kg m^2, body axes
    std::vector<int> support;  ///< columns that move this body: ancestors' first, its own last
  };

  /// A joint to the ground that can move and turn in all directions.
  struct FreeJoint {
    int body = -1;      ///< index into bodies()
    int state_idx = 0;  ///< x[state_idx + 0..2] position, + 3..6 quaternion w x y z
    int speed_idx = 0;  ///< v[speed_idx + 0..2] linear, + 3..5 angular
    Matrix3d rotation_axes = Matrix3d::Identity();     ///< columns: axes of the three angles, in order
    Matrix3d translation_axes = Matrix3d::Identity();  ///< columns: axes of the three translations
    int rotation_coordinate[3] = {-1, -1, -1};         ///< indices into coordinates(), in order
    int translation_coordinate[3] = {-1, -1, -1};      ///< indices into coordinates(), in order
  };

  /// A marker on a body.
  struct Marker {
    int body = data::kGround;               ///< index into bodies(), or data::kGround
    Vector3d x_in_body = Vector3d::Zero();  ///< m
  };

  /// Two points that must coincide (closed loop).
  struct PointConstraint {
    int body_a = data::kGround, body_b = data::kGround;  ///< indices into bodies(), or data::kGround
    Vector3d point_in_a = Vector3d::Zero(), point_in_b = Vector3d::Zero();  ///< m
  };

  /// Compile a description. Fails with its validate() sentence, or when joints cannot be ordered.
  static Result<Model> compile(data::ModelDescription description, const CompileOptions& options = {});

  /// what it was compiled from
  [[nodiscard]] const data::ModelDescription& description() const { return description_; }
  [[nodiscard]] int coordinate_count() const { return static_cast<int>(coordinates_.size()); }  ///< n
  [[nodiscard]] int speed_count() const { return speed_count_; }                                ///< nv
  [[nodiscard]] int state_count() const { return state_count_; }                        ///< numbers in x
  [[nodiscard]] int marker_count() const { return static_cast<int>(markers_.size()); }  ///< M
  [[nodiscard]] std::span<const Body> bodies() const { return bodies_; }  ///< parents before children
  /// n, in the order of the description
  [[nodiscard]] std::span<const Coordinate> coordinates() const { return coordinates_; }
  /// Order in which coordinates can be evaluated: sources before what is coupled to them.
  [[nodiscard]] std::span<const int> coordinate_order() const { return coordinate_order_; }
  [[nodiscard]] std::span<const Primitive> primitives() const { return primitives_; }    ///< body by body
  [[nodiscard]] std::span<const Column> columns() const { return columns_; }             ///< body by body
  [[nodiscard]] std::span<const FreeJoint> free_joints() const { return free_joints_; }  ///< one a free root
  /// M, in the order of the description
  [[nodiscard]] std::span<const Marker> markers() const { return markers_; }
  /// K, in the order of the description
  [[nodiscard]] std::span<const PointConstraint> point_constraints() const { return point_constraints_; }
  [[nodiscard]] Vector3d gravity() const { return description_.gravity; }  ///< m/s^2, in the world
  /// Tree index of a body of the description (bodies are reordered parents first).
  [[nodiscard]] int body_of(int description_idx) const;
  /// All coordinates at the file's default values, couplings applied.
  [[nodiscard]] VectorXd default_state() const;

 private:
  friend class Compiler;
  data::ModelDescription description_;
  std::vector<Body> bodies_;
  std::vector<int> body_of_;
  std::vector<Coordinate> coordinates_;
  std::vector<int> coordinate_order_;
  std::vector<Primitive> primitives_;
  std::vector<Column> columns_;
  std::vector<FreeJoint> free_joints_;
  std::vector<Marker> markers_;
  std::vector<PointConstraint> point_constraints_;
  int speed_count_ = 0;
  int state_count_ = 0;
};

}  // namespace kinemark::model
