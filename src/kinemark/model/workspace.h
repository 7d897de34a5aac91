// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "kinemark/model/model.h"

namespace kinemark::model {

/// Rigid inertia about the world origin: mass, first moment (mass times centre), second moment.
struct SpatialInertia {
  double mass = 0.0;                   ///< kg
  Vector3d first = Vector3d::Zero();   ///< kg m
  Matrix3d second = Matrix3d::Zero();  ///< kg m^2
};

/// One thread's scratch for one model. Sized once; the functions below allocate nothing.
///
/// Which function fills what: kinematics(): q, dq, body poses, columns, marker positions. velocities(): body
/// velocities and bias accelerations. The rest is scratch. World axes throughout.
struct Workspace {
  /// Sizes everything for a model.
  explicit Workspace(const Model& model);

  // kinematics()
  VectorXd q;                                ///< n, coordinates as the file names them
  VectorXd q_slope, q_curvature;             ///< n, dq/dv and d2q/dv2 of coupled and plain coordinates
  std::vector<Matrix3d> rotation;            ///< world_from_body
  std::vector<Vector3d> position;            ///< body origin, m
  std::vector<Matrix3d> joint_rotation;      ///< world_from_joint before the joint's motion
  std::vector<Matrix3d> joint_out_rotation;  ///< world_from_joint after the joint's motion
  std::vector<Spatial> primitive;            ///< unit motion field of each primitive
  std::vector<double> slope, second_slope;   ///< d(value)/d(speed of first and second coordinate)
  std::vector<double> curvature, cross_curvature, second_curvature;  ///< second derivatives of the value
  std::vector<Spatial> column;                                       ///< motion field of each column
  Eigen::Matrix3Xd marker;                                           ///< 3 x M, m

  // velocities()
  VectorXd v;  ///< nv, speeds as given
  std::vector<Spatial> body_velocity,
      body_bias;  ///< fields about the world origin; bias: acceleration at zero vdot

  // scratch
  std::vector<SpatialInertia> inertia, composite;  ///< of each body; scratch
  std::vector<Spatial> force;                      ///< N m and N; scratch
  std::vector<Matrix3d> moment;                    ///< scratch
};

}  // namespace kinemark::model
