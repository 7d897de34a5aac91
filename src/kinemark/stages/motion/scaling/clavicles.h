// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"

namespace kinemark::motion {

/// Give a model whose shoulders are fixed in the trunk two coordinates per clavicle, clav_protraction_r/_l
/// (forward positive) and clav_elevation_r/_l (up positive), +-0.7 rad, not clamped.
///
/// A body clavicle_r/_l that is welded to the trunk starts to move; where humerus_r/_l hangs on the trunk
/// directly, a clavicle of 0.3 kg (taken from the trunk) is put in, from 30 mm beside the middle of the trunk
/// to the shoulder. Axes as in OpenSim's models: x forward, y up, z right. Coordinates are appended. Returns
/// the names of the clavicles that move now; fails when there is no humerus or every clavicle moves already.
[[nodiscard]] Result<std::vector<std::string>> add_clavicles(data::ModelDescription& model);

}  // namespace kinemark::motion
