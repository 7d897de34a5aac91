// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/stages/motion/control/task.h"

namespace kinemark::motion::internal {

/// A point of the world that rides on a body (index in the model; data::kGround: it stays).
struct RidingPoint {
  int body;
  Eigen::Vector3d x_in_world;  ///< m
};

/// Add u . d(point)/dv to row 0.
void add_point(const model::Model& model, const model::Workspace& w, const RidingPoint& point,
               const Eigen::Vector3d& u, Eigen::MatrixXd& J);

/// First and second rate of the length of a way.
/// @param rate, rate_2  of the way itself
struct LengthRates {
  double first, second;
  LengthRates(const Eigen::Vector3d& way, const Eigen::Vector3d& rate, const Eigen::Vector3d& rate_2);
};

/// Velocity, bias and Jacobian of the distance of two points, row 0; returns the distance, m. 0: they
/// coincide, and the row is left as it is.
double distance_row(const model::Model& model, const model::Workspace& w, const RidingPoint& a,
                    const RidingPoint& b, TaskRows& out);

}  // namespace kinemark::motion::internal
