// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joints of a model that no body has.
#pragma once

#include <string>
#include <vector>

#include "kinemark/data/model_description.h"

namespace kinemark::analysis {

/// Joints that turn by two coordinates about one axis: rotations that follow each other, but for constant
/// ones, and whose axes lie within 1 deg of each other. A sentence each.
[[nodiscard]] std::vector<std::string> contradicted_joints(const data::ModelDescription& model);

}  // namespace kinemark::analysis
