// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Rows of numbers, one a frame, under whatever header a maker of cameras writes: frame and time where they
// are stored, then three cells a marker.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/time_column.h"

namespace kinemark::io::internal {

/// What stands in the columns of such rows.
struct MarkerColumns {
  enum class Kind : std::uint8_t {
    frame,
    time,
    condition,  ///< before the coordinates of its marker: 0 or below where the marker was not seen
    coordinate,
    unread
  };
  struct Column {
    Kind kind = Kind::unread;
    std::int32_t marker = -1;  ///< of a coordinate or a condition: index of its name
    std::int8_t axis = 0;      ///< of a coordinate: 0, 1, 2
  };

  char separator = '\t';               ///< tab or comma; cells may be blank
  std::vector<Column> columns;         ///< of a row, from the left
  std::vector<std::string> names;      ///< M marker names, unique
  double units_per_metre = 1000.0;     ///< coordinates of the file are divided by it
  double time_units_per_second = 1.0;  ///< times of the file are divided by it
  bool is_time_unit_open = false;      ///< nothing says that times are in seconds
  std::vector<double> rates_hz;     ///< stated rates, in order of trust; without a time column, one at least
  std::int64_t stated_frames = -1;  ///< of the header; negative: not stated
  bool zeros_are_missing = false;   ///< (0, 0, 0) is not seen, except where a path goes through it
  std::int64_t others = 0;          ///< how many of the last names are no positions: their zeros are numbers
};

/// Reads rows up to a blank line or the end of the text into `trial`: markers, their time base, first_frame
/// and warnings. A sample is missing where one of its three cells is blank, no finite number, or not there,
/// and where its condition is blank or not above 0. Times come from the time column (even_clock()), or else
/// from frame numbers, which increase, and the stated rate. Errors carry line and column, not the file.
/// O(bytes); no more than two samples a byte of text plus a million.
[[nodiscard]] Status read_marker_rows(Lines& lines, const MarkerColumns& columns, std::size_t text_bytes,
                                      data::Trial& trial);

/// Samples that are (0, 0, 0) become missing, except where the marker passes through the origin: the samples
/// before and after the zeros lie within 5 mm of it. How many of marker `m` were turned.
std::int64_t remove_zeros(data::Trajectories& markers, std::int64_t m);

/// The same of all markers but the last `others`, with a warning that names them.
void take_zeros_as_missing(data::Trial& trial, std::int64_t others);

/// Whether three coordinates, in the file's own unit, are one number by which programs mark what was not
/// seen: 999, 9999, 99999, ... or its negative.
[[nodiscard]] bool marks_missing(double x, double y, double z);

/// The largest of the three extents of all samples, in the unit that they are in; 0 without any.
[[nodiscard]] double largest_extent(const data::Trajectories& markers);

/// Rows that were read one after another, as the frames that they are by the clock; frames without a row are
/// missing. Where rows and frames are the same nothing changes but the time base.
void spread_rows(data::Trajectories& markers, const EvenClock& clock);

/// Code::bad_input for a cell that holds no number, or nothing. `column` counts from 1; `what`: "the time".
[[nodiscard]] Status bad_cell(std::int64_t line, std::int64_t column, std::string_view what,
                              std::string_view cell);

}  // namespace kinemark::io::internal
