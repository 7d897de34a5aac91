// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What steps of finite length cost. Formula: docs/theory/direct-marker-control.md
#pragma once

#include <string>

#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"

namespace kinemark::motion::internal {

/// RMS over angles of joints, rad: what steps of length h with critically damped gains add at most, 2 omega h
/// times h q''' / (2 omega^2) (1 - omega h / 3) with the third derivatives of the motion.
[[nodiscard]] double step_error(const model::Model& model, const data::JointMotion& motion, double step_s,
                                double omega_rad_s);

/// RMS over angles of joints, rad, of their standard deviations where they are known; NaN where none is.
[[nodiscard]] double stated_error(const model::Model& model, const data::JointMotion& motion);

/// Longest step, a frame or a whole part of it, whose error at omega = 0.5 / step is not above `most` (rad);
/// not much below 0.1 ms.
[[nodiscard]] double step_for(const model::Model& model, const data::JointMotion& motion, double most);

/// A warning where steps cost angles more than 0.3 of what they are known to, and more than 0.01 deg; else
/// empty.
[[nodiscard]] std::string warn_of_step(const model::Model& model, const data::JointMotion& motion,
                                       double step_s, double omega_rad_s);

}  // namespace kinemark::motion::internal
