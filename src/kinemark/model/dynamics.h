// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"

namespace kinemark::model {

/// Joint-space mass matrix M(x), nv x nv, symmetric; M is resized once. After kinematics(). Composite rigid
/// bodies (Featherstone 2008, section 6.2). Units follow the speeds: kg, kg m, kg m^2.
void mass_matrix(const Model& model, Workspace& w, Eigen::MatrixXd& M);

/// Velocity-dependent forces b(x, v) of  M vdot + b + g = tau.  After velocities(). Recursive Newton-Euler
/// (Featherstone 2008, section 5.3).
void bias_forces(const Model& model, Workspace& w, VectorXd& b);

/// Gravity forces g(x): the generalised forces that hold the body still. After kinematics().
void gravity_forces(const Model& model, Workspace& w, VectorXd& g);

/// Generalised forces tau = M vdot + b + g in one sweep, without forming M. After velocities(). Recursive
/// Newton-Euler (Featherstone 2008, section 5.3).
void inverse_dynamics(const Model& model, Workspace& w, const VectorXd& vdot, VectorXd& tau);

/// Kinetic energy v'Mv/2, J. After velocities().
[[nodiscard]] double kinetic_energy(const Model& model, const Workspace& w);

/// Potential energy against gravity, zero at the world origin, J. After kinematics().
[[nodiscard]] double potential_energy(const Model& model, const Workspace& w);

}  // namespace kinemark::model
