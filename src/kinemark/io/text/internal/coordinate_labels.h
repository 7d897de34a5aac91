// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What people write above the columns of a table of coordinates, and which columns belong to one marker.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/io/text/internal/cells.h"

namespace kinemark::io::internal {

/// What may stand between a name and its axis.
inline constexpr std::string_view kBetweenNameAndAxis = "_.:/| -";

/// A label in its parts: "LASI_X (mm)" is of marker LASI, axis 0, in mm; "Time [s]" is a time in s.
struct CoordinateLabel {
  static constexpr int kW = 3;

  std::string name;                ///< of the marker, or the whole label
  int axis = -1;                   ///< 0, 1, 2 of x, y, z; kW of the fourth of a quaternion; negative: none
  std::string unit;                ///< empty: none stated
  bool of_d_flow = false;          ///< "LASI.PosX"
  bool is_frame = false;           ///< number of the frame
  double units_per_second = 0.0;   ///< 1000 of a time in ms; 0: no time
  bool is_time_unit_open = false;  ///< a time whose unit nothing states: seconds, if they look like it
  std::int32_t marker = -1;        ///< of a coordinate: index of its marker

  /// Of a time or a number of frames.
  [[nodiscard]] bool is_clock() const { return is_frame || units_per_second > 0.0; }
};

/// The labels of a table, and where they stand.
struct CoordinateLabels {
  std::vector<CoordinateLabel> columns;  ///< empty: no table of coordinates
  std::vector<std::string> names;        ///< of the markers; "" of x, y and z alone
  std::vector<std::string> units;        ///< a line of units above the axes, a cell a column; may be empty
  bool are_numbered = false;             ///< 1, 2 and 3, or 0, 1 and 2, stand for x, y and z
};

/// A label by itself: "LASI_X", "LASI.x", "x_LASI", "LASI[X]", "LASI X (mm)", "LASI_pos_x", "LASI/X_mm". What
/// is of the same marker is not known yet.
[[nodiscard]] CoordinateLabel coordinate_label(std::string_view cell);

/// The labels of the table that begins here: in one line, or names above a line of x, y and z with other
/// lines between, and with titles or comments before it. Columns of one marker may stand in any order. Where
/// every column but times and frames is one of three of its name, they may be numbered: "LASI_1", "LASI.2",
/// "LASI[0]"; three of "Marker" are three markers, and no marker with three coordinates. A line below names
/// and axes that names the other columns alone ("time,,,") is the last of the labels. `lines` is then at the
/// last line of labels. Nothing where no marker has all of x, y and z, or where most columns are others and
/// the first is none of a marker.
[[nodiscard]] CoordinateLabels read_coordinate_labels(Lines& lines);

/// Gives labels that are numbered their axes. Every column but clocks is one of three of its name, numbered
/// from 0 or from 1 in all of them; a fourth that is 1 in the first row is that of homogeneous coordinates,
/// which kineticstoolkit writes. False: they are no such labels, and stay.
[[nodiscard]] bool take_numbered_axes(std::vector<CoordinateLabel>& labels,
                                      const std::vector<std::string>& first_row);

/// Cells of a line between tabs, else between commas, without quotes. False: a quote is open at its end.
[[nodiscard]] bool split_labels(std::string_view line, std::vector<std::string>& cells);

}  // namespace kinemark::io::internal
