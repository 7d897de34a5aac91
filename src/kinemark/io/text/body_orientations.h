// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Orientations of the rigid bodies that a recording of QTM (6D) holds as channels: the axes of each.
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/orientations.h"
#include "kinemark/data/trial.h"

namespace kinemark::io {

/// Whether a recording has the axes of a body: channels NAME_axis_x, NAME_axis_y and NAME_axis_z.
[[nodiscard]] bool has_body_axes(const data::Trial& trial);

/// world_from_body of each body with three axes, the rotation nearest to them; missing where one of them is.
/// Code::bad_input where there is none, or axes that are not of length 1 and at right angles, to a hundredth.
[[nodiscard]] Result<data::Orientations> orientations_of_bodies(const data::Trial& trial);

}  // namespace kinemark::io
