// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Rows of numbers, one a frame, under whatever header a maker of cameras writes: frame and time where they
// are stored, then three cells a marker.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/text/internal/cells.h"

namespace kinemark::io::internal {

/// What stands in the columns of such rows.
struct MarkerColumns {
  enum class Kind : std::uint8_t { frame, time, coordinate, unread };
  struct Column {
    Kind kind = Kind::unread;
    std::int32_t marker = -1;  ///< of a coordinate: index of its name
    std::int8_t axis = 0;      ///< of a coordinate: 0, 1, 2
  };

  char separator = '\t';            ///< tab or comma; cells may be blank
  std::vector<Column> columns;      ///< of a row, from the left
  std::vector<std::string> names;   ///< M marker names, unique
  double units_per_metre = 1000.0;  ///< coordinates of the file are divided by it
  std::vector<double> rates_hz;     ///< stated rates, in order of trust; without a time column, one at least
  std::int64_t stated_frames = -1;  ///< of the header; negative: not stated
  bool zeros_are_missing = false;   ///< (0, 0, 0) is not seen, except where a path goes through it
};

/// Reads rows up to a blank line or the end of the text into `trial`: markers, their time base, first_frame
/// and warnings. A sample is missing where one of its three cells is blank, no finite number, or not there.
/// Times come from the time column, or from frame numbers and the stated rate; one rule for both
/// (even_clock()). Errors carry line and column, not the file. O(bytes); no more than two samples a byte of
/// text plus a million.
[[nodiscard]] Status read_marker_rows(Lines& lines, const MarkerColumns& columns, std::size_t text_bytes,
                                      data::Trial& trial);

/// Samples that are (0, 0, 0) become missing, except where the marker passes through the origin: the samples
/// before and after the zeros lie within 5 mm of it. How many of marker `m` were turned.
std::int64_t remove_zeros(data::Trajectories& markers, std::int64_t m);

}  // namespace kinemark::io::internal
