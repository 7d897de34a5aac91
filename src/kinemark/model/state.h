// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"

namespace kinemark::model {

/// x moved by a small motion dv (nv): additive, but along the rotation group for free joints. In place.
void integrate(const Model& model, VectorXd& x, const VectorXd& dv);

/// The motion dv with integrate(from, dv) == to; the inverse of integrate() for rotations below 180 deg.
void difference(const Model& model, const VectorXd& from, const VectorXd& to, VectorXd& dv);

/// State whose coordinates are q (n numbers). Coupled coordinates in q are ignored: the couplings define
/// them.
[[nodiscard]] VectorXd state_from_coordinates(const Model& model, const VectorXd& q);

/// Coordinates of a state. `near` (n): Euler angles of free joints are chosen on the branch nearest to it.
void coordinates_from_state(const Model& model, const VectorXd& x, const VectorXd& near, VectorXd& q);

/// dq/dv, n x nv, at state x with coordinates q: the identity for plain coordinates, the coupling's slope for
/// coupled ones, the Euler rates for free joints (without bound where the middle angle is 90 deg). E is
/// resized once. After kinematics() of the same x.
void coordinate_jacobian(const Model& model, const Workspace& w, const VectorXd& q, Eigen::MatrixXd& E);

}  // namespace kinemark::model
