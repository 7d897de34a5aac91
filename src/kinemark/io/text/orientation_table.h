// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Orientations of inertial sensors in the tables of OpenSim's OpenSense: .sto with DataType=Quaternion.
#pragma once

#include <filesystem>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/orientations.h"

namespace kinemark::io {

/// Read such a table: a column a sensor, cells "w,x,y,z", which take the sensor's axes to those of its world.
/// Quaternions are made unit; one that is 0 (a warning says so) or not a number is missing. Times are settled
/// as those of a TRC; a gap in them is frames without orientations.
///
/// Code::bad_input where the table holds no orientations, or a quaternion whose length is off 1 by a tenth;
/// else as read_table().
[[nodiscard]] Result<data::Orientations> read_orientations(const std::filesystem::path& path);

/// Whether a .mot or .sto says that it holds orientations. Fails where its beginning is no table's.
[[nodiscard]] Result<bool> holds_orientations(const std::filesystem::path& path);

/// Write orientations by the ending: .sto as OpenSense has them, .csv as read_orientation_csv() reads them.
/// Numbers are the shortest that read back exactly. What is missing is NaN, in .csv blank. Code::usage for
/// other endings, Code::bad_input for names with a tab, comma, quote or line end, Code::io as OutputFile.
[[nodiscard]] Status write_orientations(const std::filesystem::path& path, const data::Orientations& what,
                                        bool force = false);

/// read_orientations() from memory; `name` stands for the file in messages.
[[nodiscard]] Result<data::Orientations> parse_orientations(std::string_view text, std::string_view name);

}  // namespace kinemark::io
