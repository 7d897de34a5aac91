// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A motion and its model, held against each other.
#pragma once

#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"
#include "kinemark/workflow/motion/dynamics.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow::internal {

/// Axes of a joint that lie upon each other miss the gate `contradictions`; coordinates out of their ranges
/// are a warning each: models have narrower ones than people.
void hold_model(const model::Model& model, const data::JointMotion& motion, Remarks& remarks);

/// The same, and what is contradicted of the motion as it was given.
/// @param mass_centre  it is followed, and no torque is found whose own gate says what masses are like:
///                     centres of mass outside of the body count
void hold_motion(const model::Model& model, const GivenMotion& given, bool mass_centre, Remarks& remarks);

}  // namespace kinemark::workflow::internal
