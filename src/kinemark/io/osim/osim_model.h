// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"

namespace kinemark::io {

/// Read an OpenSim model, document versions 10500 to 40600: bodies, joints, coordinates, couplers, point
/// constraints, markers. Muscles, forces, geometry and controllers are passed over in silence; a constraint
/// of another kind leaves a warning in the description. Sets that stand in other files (`file=` attributes)
/// are read.
///
/// Joints: Custom, Pin, Slider, Universal, Planar, Ball, Gimbal, Free, Weld, Ellipsoid, Scapulothoracic.
/// Coordinates come in the order of OpenSim's result files. A scapulothoracic joint becomes two,
/// "<joint>_sliding" and "<joint>", with the massless body "<joint>_intermediate" between; so does a
/// CustomJoint with rotations and translations whose child is nearer to the ground than its parent
/// ("<joint>_rotation" and "<joint>").
///
/// Anything wrong or not supported is one sentence that names the file, the element and what was found. The
/// result has passed validate().
[[nodiscard]] Result<data::ModelDescription> read_osim(const std::filesystem::path& path);

/// The same from text; `name` stands for the file in messages. Sets in other files are refused.
[[nodiscard]] Result<data::ModelDescription> parse_osim(std::string_view xml, std::string_view name);

}  // namespace kinemark::io
