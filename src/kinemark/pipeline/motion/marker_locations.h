// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/data/joint_motion.h"
#include "kinemark/data/table.h"
#include "kinemark/model/model.h"

namespace kinemark::pipeline {

/// Where a motion puts the markers of its model, all of them in all frames, as OpenSim's table of marker
/// locations has it: columns NAME_tx, NAME_ty, NAME_tz, metres in the model's world. O(frames x bodies).
///
/// @param motion  of `model`: its coordinates in the model's order
[[nodiscard]] data::Table marker_locations_table(const model::Model& model, const data::JointMotion& motion);

}  // namespace kinemark::pipeline
