// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kinemark/model/model.h"

namespace kinemark::model::testing {

/// The same tree as an MJCF document; hinges are named "c" and the coordinate's number, sites "m" and the
/// marker's. Works where all axes are rotations and joint frames do not rotate the body at zero: in the
/// child's frame the hinges then stand at one point, in the order of the description. Anything else fails the
/// test.
[[nodiscard]] std::string mjcf(const Model& model);

}  // namespace kinemark::model::testing
