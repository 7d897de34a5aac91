// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/channels.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/marker_rows.h"

namespace kinemark::io::internal {

/// What stands above the rows of an export; events, software and warnings go into the trial at once.
struct VendorHeader {
  MarkerColumns columns;
  /// State of each marker's samples; empty: all measured.
  std::vector<data::SampleState> state;
  /// What was read as markers behind the real ones, three numbers a frame, and is no position: each becomes a
  /// channel. Missing where its body is.
  struct Output {
    std::int64_t body = 0;  ///< index of the marker that is the body's origin
    data::ChannelKind kind = data::ChannelKind::other;
    std::string unit;
  };
  std::vector<Output> outputs;
  bool is_unit_open = false;  ///< coordinates are left as they stand: no unit is known
};

/// Each reads up to the last line before the rows. Errors carry the line, not the file.
[[nodiscard]] Result<VendorHeader> parse_qtm_header(Lines& lines, data::Trial& trial);
[[nodiscard]] Result<VendorHeader> parse_motive_header(Lines& lines, data::Trial& trial);
[[nodiscard]] Result<VendorHeader> parse_vicon_header(Lines& lines, data::Trial& trial);
[[nodiscard]] Result<VendorHeader> parse_phasespace_header(Lines& lines, data::Trial& trial);

/// The rows above the numbers of a Motive file, a cell a column.
struct MotiveRows {
  std::vector<std::string> type, name, component, axis;
  std::int64_t name_line = 0;
};

/// Line 1, whose rates and unit go into `columns` and `trial`, and the rows up to the one that begins with
/// Frame.
[[nodiscard]] Result<MotiveRows> parse_motive_rows(Lines& lines, MarkerColumns& columns, data::Trial& trial);

/// A table of coordinates; `unit` is the one that the user gives, or empty, and `rate_hz` that of a table
/// without times, or 0.
[[nodiscard]] Result<VendorHeader> parse_coordinates_header(Lines& lines, data::Trial& trial,
                                                            std::string_view unit, double rate_hz);
/// Whether a text begins as one: x, y and z of a marker are the first columns that are neither time nor
/// frame.
[[nodiscard]] bool begins_coordinates(std::string_view begin);
/// Whether it begins as one of Motek's D-Flow: labels such as "LASI.PosX".
[[nodiscard]] bool begins_d_flow(std::string_view begin);
/// Whether it begins as one that has no column of times.
[[nodiscard]] bool begins_coordinates_without_times(std::string_view begin);

/// 1000 for "mm" or "Millimeters". Code::bad_input, naming
/// the line, for any other word.
[[nodiscard]] Result<double> units_per_metre(std::string_view unit, std::int64_t line);

/// Names that are there and unique; warnings say how many were not.
void settle_marker_names(std::vector<std::string>& names, std::int64_t line, data::Trial& trial);

}  // namespace kinemark::io::internal
