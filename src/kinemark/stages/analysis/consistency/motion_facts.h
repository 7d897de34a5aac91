// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Coordinates of a motion against what its model lets them be.
#pragma once

#include <string>
#include <vector>

#include "kinemark/data/joint_motion.h"
#include "kinemark/data/model_description.h"

namespace kinemark::analysis {

/// Coordinates that leave the range that the model has for them, clamped or not: by more than 10 deg and a
/// twentieth of the range, 30 mm and a twentieth of a translation's, in a twentieth of the frames and three
/// at least. A sentence each, with the largest excess and the frames; of more than five the others are
/// counted. A body that moves in space may turn as it likes: coordinates of a joint to the ground that also
/// translates are not asked, nor those that the model holds, nor values that are not determined.
[[nodiscard]] std::vector<std::string> coordinates_out_of_range(const data::ModelDescription& model,
                                                                const data::JointMotion& motion);

}  // namespace kinemark::analysis
