// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Forces of the plates in a text of Motek's D-Flow (GRAIL, CAREN, instrumented treadmills).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/table.h"

namespace kinemark::io {

/// What a trial of such a text names as not read (data::Trial::unread), where it holds forces.
inline constexpr const char* kForcesOfDFlow = "forces of plates (FP1.ForX and so on)";

/// Whether the first line labels a time and the force and its point of a plate: "FP1.ForX" (N), "FP1.CopX"
/// (m), and perhaps "FP1.MomX" (N m).
[[nodiscard]] bool begins_d_flow_forces(std::string_view begin);

/// Of these labels, those of plates whose force and its point are there.
[[nodiscard]] std::vector<std::string> d_flow_force_labels(const std::vector<std::string>& labels);

/// The forces on the body, row by row, in the axes of the file: "plate 1_vx" (force, N), "plate 1_px" (where
/// it acts, m) and "plate 1_mx" (free moment, N m), and so on, as loads_of_columns() takes them; 0 in rows in
/// which less than `contact_force_n` acts along the vertical, the axis of the largest force. Moments become
/// free ones: those that the file has are about its origin or about the point of the force, whichever leaves
/// the smaller moment across the vertical. Forces that push down are those of the body on the plate; they are
/// reversed. What was settled is said in `warnings` of the table, and that the corners of the plates are not
/// known.
///
/// Code::bad_input, one sentence, where begins_d_flow_forces() is false, a time is no number or does not
/// increase, or there is no row.
[[nodiscard]] Result<data::Table> parse_d_flow_forces(std::string_view text, std::string_view name,
                                                      double contact_force_n);
/// The same of a file.
[[nodiscard]] Result<data::Table> read_d_flow_forces(const std::filesystem::path& path,
                                                     double contact_force_n);

}  // namespace kinemark::io
