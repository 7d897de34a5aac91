// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The body as one along a motion: its mass centre, its angular momentum, and points of it; values alone, for
// what is computed many times over.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"

namespace kinemark::motion {

/// A point, fixed in a body, whose path is asked for.
struct PointOnBody {
  int body = data::kGround;                     ///< index in Model::bodies(), or data::kGround
  Eigen::Vector3d x_in_body = {0.0, 0.0, 0.0};  ///< m
};

/// F frames, P points. World axes.
struct WholeBody {
  double mass_kg = 0.0;                  ///< of all bodies
  Eigen::MatrixX3d centre;               ///< F x 3, mass centre, m
  Eigen::MatrixX3d centre_velocity;      ///< F x 3, m/s
  Eigen::MatrixX3d momentum;             ///< F x 3, angular momentum about the mass centre, kg m^2/s
  std::vector<Eigen::MatrixX3d> points;  ///< P, each F x 3, m
};

/// Follow the whole body along a motion whose qd is there.
///
/// L = sum m_i (x_i - c) x (v_i - v_c) + R_i I_i R_i' w_i over the bodies, with x_i their mass centres and c
/// that of all (Herr & Popovic 2008, eq. 1).
///
/// @return Code::bad_input for a motion that is not of the model or has no speeds, and for a model without
///         mass. About 5 us a frame of a whole body.
[[nodiscard]] Result<WholeBody> whole_body(const model::Model& model, const data::JointMotion& motion,
                                           const std::vector<PointOnBody>& points = {});

}  // namespace kinemark::motion
