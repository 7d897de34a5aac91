// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::io {

/// Write the markers of a trial as comma-separated values (RFC 4180) in long form: a header line and one line
/// for each marker and frame, missing ones too,
///   frame,time_s,marker,x_m,y_m,z_m,state,method
/// and, where the trial has them, offset_s (of the sample after its frame) and sd_x_m, sd_y_m, sd_z_m,
/// cov_xy_m2, cov_xz_m2, cov_yz_m2. Numbers are the shortest that read back exactly; what is not there is
/// blank. Code::bad_input when the trial is invalid; Code::io as OutputFile. docs/formats/csv.md
[[nodiscard]] Status write_trajectories_csv(const std::filesystem::path& path, const data::Trial& trial,
                                            bool force);

/// Read such a file; columns in any order, lines in any order. Needed are frame, time_s, marker, x_m, y_m and
/// z_m; a sample without a state is measured where it has coordinates and missing where it has none. The
/// clock is the even one that describes time_s best. Tables of one line a sample under other people's labels
/// ("Time (ms),Name,X,Y,Z") are read too, with `unit` where their labels state none. Anything that makes no
/// sense: Code::bad_input with the line; Code::usage for a unit beside columns of our own.
[[nodiscard]] Result<data::Trial> read_trajectories_csv(const std::filesystem::path& path,
                                                        std::string_view unit = {});
/// The same from memory; `name` stands in messages. Memory is bounded by a multiple of the text.
[[nodiscard]] Result<data::Trial> parse_trajectories_csv(std::string_view text, const std::string& name,
                                                         std::string_view unit = {});

}  // namespace kinemark::io
