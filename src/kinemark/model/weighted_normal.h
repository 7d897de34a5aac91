// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Least squares over markers without a Jacobian.
//
// J'WJ of all markers equals the mass matrix of a tree whose bodies are made of point masses w_i at the
// markers, and J'Wr equals the generalised forces of forces w_i r_i applied there. Both are computed in one
// sweep over the tree, and so does the exact second-order term  sum_i w_i r_i . d2p_i/dv dv:  for motion
// fields (w_c, v_c) above (w_d, v_d) it is w_c . (v_d x F + (A - tr(A) I) w_d)  with  F = sum w_i r_i,  A =
// sum w_i p_i r_i'  over the markers moved by d.
#pragma once

#include <Eigen/Core>

#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"

namespace kinemark::model {

/// H = J'WJ (nv x nv, lower triangle and diagonal filled, then mirrored). `weight` has M entries >= 0. After
/// kinematics().
void marker_normal_matrix(const Model& model, Workspace& w, const VectorXd& weight, Eigen::MatrixXd& H);

/// Forces at points of bodies: start with none, add, then project.
void clear_forces(Workspace& w);
/// A force (world axes) at a world point of a body (tree index; the ground takes it without effect).
void add_force(Workspace& w, int body, const Vector3d& x_in_world, const Vector3d& force);

/// Forces w_i r_i at all markers, for residuals r (3 x M, m; entries of weight 0 are not read). After
/// kinematics().
void add_marker_forces(const Model& model, Workspace& w, const VectorXd& weight,
                       const Eigen::Matrix3Xd& residual);

/// g = sum over the added forces of (d point / dv)' force; for marker forces that is J'Wr. Call once per
/// clear_forces().
void project_forces(const Model& model, Workspace& w, VectorXd& g);

/// H -= sum over the added forces of force . d2 point / dv dv. With marker forces this makes a Gauss-Newton
/// matrix the exact Hessian of sum w |r|^2 / 2. After project_forces().
void subtract_force_curvature(const Model& model, Workspace& w, Eigen::MatrixXd& H);

}  // namespace kinemark::model
