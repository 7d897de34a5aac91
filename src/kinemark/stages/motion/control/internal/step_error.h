// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What steps of finite length cost. Formula: docs/theory/direct-marker-control.md
#pragma once

#include <string>

#include <Eigen/Core>

#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/control/internal/plan.h"
#include "kinemark/stages/motion/control/internal/walker.h"

namespace kinemark::motion::internal {

/// RMS over angles of joints, rad: what steps of length h with critically damped gains may add, 2 omega h
/// times h q''' / (2 omega^2) (1 - omega h / 3) with the third derivatives of the motion.
[[nodiscard]] double step_error(const model::Model& model, const data::JointMotion& motion, double step_s,
                                double omega_rad_s);

/// RMS over angles of joints, rad, of their standard deviations where they are known; NaN where none is.
[[nodiscard]] double stated_error(const model::Model& model, const data::JointMotion& motion);

/// rad: what steps may cost of angles that are `known` to so much: 0.2 of it, or 0.01 deg.
[[nodiscard]] double tolerated_cost(double known);

/// The same control with steps of a quarter of the length, as stiff as they allow.
[[nodiscard]] Plan with_finer_steps(const Plan& plan);

/// RMS over angles of joints, rad: how far a body that goes by finer steps is from one that has followed the
/// recording (one column of `states` per frame). The finer one begins anew for each second that is compared,
/// 10 at most, spread over the recording; its samples must be there.
[[nodiscard]] double step_cost(const Plan& plan, const Eigen::MatrixXd& states, Walker& finer);

/// Longest step, a whole part of `step_s`, that costs at most `most` (rad) at omega = 0.5 / step, where
/// step_s costs `cost`; not much below 0.1 ms.
[[nodiscard]] double step_for(double step_s, double cost, double most);

/// The warning where steps cost more than is tolerated of angles that are `known` to so much, else empty.
[[nodiscard]] std::string warn_of_step(const Plan& plan, double cost, double known);

}  // namespace kinemark::motion::internal
