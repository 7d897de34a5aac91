// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// OpenSim's ExternalLoads: which columns of a table push which body.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/table.h"
#include "kinemark/data/wrenches.h"

namespace kinemark::io {

/// One ExternalForce that is switched on, given in the ground's frame. Identifiers are what three columns'
/// names begin with; empty: none.
struct ExternalForce {
  std::string name;  ///< unique
  std::string body;  ///< of the model
  /// Beginnings of three columns' names: force in N, its point in m, moment in N m; empty: none.
  std::string force, point, torque;
};

/// An ExternalLoads file: which columns of a table act where.
struct ExternalLoads {
  std::string source;                 ///< the file, for sentences
  std::filesystem::path data_file;    ///< relative to the folder of the file
  std::vector<ExternalForce> forces;  ///< those that are switched on
};

/// Read an ExternalLoads file. Code::not_supported, one sentence: a force or point in the frame of a body, or
/// a force without a point (which OpenSim puts at the body's origin); Code::bad_input for what is missing.
[[nodiscard]] Result<ExternalLoads> read_external_loads(const std::filesystem::path& path);
/// The same from memory; the path of the data file is relative to `folder`.
[[nodiscard]] Result<ExternalLoads> parse_external_loads(std::string_view xml, std::string name,
                                                         const std::filesystem::path& folder = {});

/// The forces that a table holds by the names of its columns, as OpenSim's ground reactions have them:
/// NAMEvx, NAMEvy, NAMEvz (force, N) beside NAMEpx, NAMEpy, NAMEpz (where it acts, m), and its free moment,
/// N m, in x, y, z behind NAME with "torque" or "moment" for "force", or in NAMEmx, NAMEmy, NAMEmz; all in
/// the laboratory, on the body. Each gets the name of its columns without the mark at its end, and no body.
/// Without any: Code::bad_input, with the columns that are needed.
[[nodiscard]] Result<ExternalLoads> loads_of_columns(const data::Table& table,
                                                     const std::filesystem::path& path);

/// Forces as such a table: 1_ground_force_vx, 1_ground_force_px, 1_ground_torque_x and so on, of each in
/// turn, one row a frame. A point where nothing acts is 0, as OpenSim has it; what was not measured stays
/// NaN.
[[nodiscard]] data::Table table_of_forces(const data::Wrenches& wrenches);

/// The loads at the frames of `time`, interpolated linearly between the rows of the table (N, m, N m). NaN
/// before its first and after its last row, beside cells that are blank, and where a force has no point.
/// Columns that are not there: Code::bad_input.
[[nodiscard]] Result<data::Wrenches> sample_external_loads(const ExternalLoads& loads,
                                                           const data::Table& table, const TimeBase& time);

}  // namespace kinemark::io
