// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::io {

/// A row of channels.tsv: what a column of motion.tsv holds.
struct MotionColumn {
  std::string name;         ///< of the column
  std::string component;    ///< "x", "y", "z", "quat_w", ..., "n/a"
  std::string type;         ///< "POS", "JNTANG", ...
  std::string point;        ///< tracked_point
  std::string units;        ///< "m", "deg", ...
  std::string description;  ///< may be empty
};

/// The columns that a trial becomes: x, y, z of each marker in metres, then of each channel that is no marker
/// in its own unit, then the time of a frame (LATENCY) where the first is not at 0; under names of their own.
[[nodiscard]] std::vector<MotionColumn> columns_of(const data::Trial& trial);

/// channels.tsv of these columns.
[[nodiscard]] std::string format_columns(const std::vector<MotionColumn>& columns);

/// The rows of a channels.tsv, which names its own columns in any order. Code::bad_input, with the line, for
/// one without name, component, type, tracked_point and units, or with a row of another width.
[[nodiscard]] Result<std::vector<MotionColumn>> parse_columns(std::string_view text);

}  // namespace kinemark::io
