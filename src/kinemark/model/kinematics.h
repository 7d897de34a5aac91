// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"

namespace kinemark::model {

/// Poses of all bodies, motion fields of all joints and positions of all markers in state x (state_count()
/// numbers). Everything else here needs it first. O(bodies + markers).
void kinematics(const Model& model, Workspace& w, const VectorXd& x);

/// Body velocities and bias accelerations for speeds v (speed_count() numbers). After kinematics().
void velocities(const Model& model, Workspace& w, const VectorXd& v);

/// World position (m) of a point fixed in a body (tree index; data::kGround for the ground). After
/// kinematics().
[[nodiscard]] Vector3d point_in_world(const Workspace& w, int body, const Vector3d& x_in_body);

/// Velocity (m/s) and acceleration at zero vdot (m/s^2, "Jdot v") of a world point moving with a body. After
/// velocities().
[[nodiscard]] Vector3d point_velocity(const Workspace& w, int body, const Vector3d& x_in_world);
/// Acceleration of such a point at zero vdot, m/s^2. After velocities().
[[nodiscard]] Vector3d point_bias_acceleration(const Workspace& w, int body, const Vector3d& x_in_world);

/// d(point)/dv, 3 x nv, of a world point moving with a body. J must have that size already. After
/// kinematics().
void point_jacobian(const Model& model, const Workspace& w, int body, const Vector3d& x_in_world,
                    Eigen::Ref<Eigen::MatrixXd> J);

/// Jacobian of all markers, 3M x nv, rows x y z of marker 0 first. J is resized once. After kinematics().
void marker_jacobian(const Model& model, const Workspace& w, Eigen::MatrixXd& J);

/// Jdot v of all markers, 3M, m/s^2. After velocities().
void marker_bias_acceleration(const Model& model, const Workspace& w, VectorXd& out);

/// Gap of every point constraint, point of a minus point of b, 3K, m; and its Jacobian 3K x nv. After
/// kinematics().
void point_constraint_gaps(const Model& model, const Workspace& w, VectorXd& gap);
/// Jacobian of the gaps, 3K x nv, per unit of speed. After kinematics().
void point_constraint_jacobian(const Model& model, const Workspace& w, Eigen::MatrixXd& C);

}  // namespace kinemark::model
