// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/core/index.h"
#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"

namespace kinemark::motion::internal {

/// Angular velocity of a body (tree index), world axes, by the speeds: A is 3 x nv already. After
/// kinematics().
inline void turning_jacobian(const model::Model& model, const model::Workspace& w, int body,
                             Eigen::MatrixXd& A) {
  A.setZero();
  for (const int c : model.bodies()[at(body)].support)
    A.col(model.columns()[at(c)].speed) += w.column[at(c)].w;
}

}  // namespace kinemark::motion::internal
