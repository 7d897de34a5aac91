// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Conversion between the rates of the file's coordinates and the speeds of the tree. Both agree except for
// free joints (Euler rates instead of angular velocity) and coupled coordinates.
#pragma once

#include <Eigen/Core>

#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"

namespace kinemark::model {

/// Speeds v and their derivative vdot (nv each) of coordinates q that change at rate qd and qdd (n each). The
/// rates of coupled coordinates are not read. Sizes v and vdot.
void speeds_from_rates(const Model& model, const VectorXd& q, const VectorXd& qd, const VectorXd& qdd,
                       VectorXd& v, VectorXd& vdot);

/// The inverse: dq/dt and d2q/dt2 of all coordinates, coupled ones by their coupling. Without bound where the
/// middle angle of a free joint is 90 deg. After kinematics() of the state with coordinates q. Sizes qd and
/// qdd.
void rates_from_speeds(const Model& model, const Workspace& w, const VectorXd& q, const VectorXd& v,
                       const VectorXd& vdot, VectorXd& qd, VectorXd& qdd);

}  // namespace kinemark::model
