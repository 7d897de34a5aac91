// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Orientations in comma-separated values: rigid bodies and bones of OptiTrack Motive, and tables of
// quaternions.
#pragma once

#include <filesystem>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/orientations.h"

namespace kinemark::io {

/// Whether a text begins (its column labels are in it) as one of these with quaternions in it.
[[nodiscard]] bool begins_orientation_csv(std::string_view begin);

/// Read one: world_from_body of each.
///
/// - Motive: columns of Type "Rigid Body" or "Bone" and their rotations as quaternions, X, Y, Z and W. Angles
///   in place of quaternions are Code::not_supported.
/// - A table: a column of time, in seconds, then NAME_w, NAME_x, NAME_y and NAME_z, as write_orientations()
///   makes it. Other columns are not read (warning).
///
/// Blank cells are missing; else as parse_orientations(). Times settle as those of a TRC, or follow from
/// frame numbers and the stated rate.
[[nodiscard]] Result<data::Orientations> read_orientation_csv(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] Result<data::Orientations> parse_orientation_csv(std::string_view text, std::string_view name);

}  // namespace kinemark::io
