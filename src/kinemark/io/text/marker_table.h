// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Positions of markers in the tables of OpenSim: what its C3D adapter, Moco and TimeSeriesTableVec3 write.
#pragma once

#include <filesystem>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::io {

/// Whether a MOT or STO file that begins like this (read_begin()) holds markers and nothing else: its cells
/// are vectors (DataType=Vec3), or all of its labels that are seen are "NAME_tx", "NAME_ty", "NAME_tz".
[[nodiscard]] bool begins_marker_table(std::string_view begin);

/// Read such a table, in metres: three columns a marker, "NAME_tx", "NAME_ty", "NAME_tz" or vectors; as
/// read_table() otherwise. Metres unless a header line says Units=mm or the like. NaN and blank cells are
/// missing samples; other columns are not read (warning). Times are settled as those of a TRC.
///
/// Code::bad_input where no three columns are of a marker, or the unit is unknown; else as read_table().
[[nodiscard]] Result<data::Trial> read_marker_table(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages and in Trial::source.
[[nodiscard]] Result<data::Trial> parse_marker_table(std::string_view text, std::string_view name);

}  // namespace kinemark::io
