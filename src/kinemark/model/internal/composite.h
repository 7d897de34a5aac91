// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Sweeps shared by the mass matrix and the marker normal matrix.
#pragma once

#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"

namespace kinemark::model::internal {

/// Momentum field of an inertia moving with s.
inline Spatial apply(const SpatialInertia& inertia, const Spatial& s) {
  Spatial f;
  f.w.noalias() = inertia.second * s.w;
  f.w += inertia.first.cross(s.v);
  f.v = inertia.mass * s.v - inertia.first.cross(s.w);
  return f;
}

inline double dot(const Spatial& a, const Spatial& b) { return a.w.dot(b.w) + a.v.dot(b.v); }

/// H_cd = sum over bodies of S_c' I S_d, with w.composite holding each body's own inertia on entry (and the
/// inertia of everything it carries on return).
void project_composites(const Model& model, Workspace& w, Eigen::MatrixXd& H);

/// g_c = S_c . (sum of w.force over the bodies that c moves); w.force holds each body's own force field on
/// entry (and the sum of everything it carries on return).
void project_forces(const Model& model, Workspace& w, VectorXd& g);

}  // namespace kinemark::model::internal
