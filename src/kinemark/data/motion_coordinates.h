// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The coordinates of a model as the columns of a motion.
#pragma once

#include "kinemark/data/joint_motion.h"
#include "kinemark/data/model_description.h"

namespace kinemark::data {

/// Whether OpenSim calls the coordinate "Coupled", and so keeps it in rad in files whose angles are in
/// degrees: it moves a CustomJoint by functions alone, none of them +-q + constant (a patella's, for
/// example). O(joints). Source: OpenSim 4.6, motion type of CustomJoint's coordinates.
[[nodiscard]] bool keeps_radians(const ModelDescription& model, int coordinate_idx);

/// Names and kinds of all coordinates of `model`, in its order, in place of those of `motion`.
void set_coordinates(const ModelDescription& model, JointMotion& motion);

}  // namespace kinemark::data
