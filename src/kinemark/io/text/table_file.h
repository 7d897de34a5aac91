// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/table.h"

namespace kinemark::io {

/// Read a MOT or STO table: the old SIMM header (datacolumns, datarows, range), OpenSim's version 1 (nRows,
/// nColumns, inDegrees) and version 3 (DataType=double, or VecN whose cells "1,2,3" become the columns
/// name_1, name_2, name_3), and tables that begin with the line of labels (warning).
///
/// A table whose checksum does not fit its content is read, with a warning.
/// Values are as written; blank and NaN cells are NaN. Where the header's counts differ from the labels and
/// rows, the labels and rows are used (warning). A row that repeats the time of the row before is left out
/// (warning). Jumps of an even time column and values that nothing measured can be are warnings. A blank
/// line ends the data. The first column is time, in any case of letters.
///
/// Code::bad_input, with line and column, for text where a number belongs, a row with too few or too many
/// cells, time that runs backwards or stands still, a label that occurs twice, no 'endheader';
/// Code::not_supported for DataType Quaternion, SpatialVec and others. Code::io when it cannot be read.
/// O(bytes); memory at most 10 times the text + 250 MB, also for hostile input, about twice for good files.
[[nodiscard]] Result<data::Table> read_table(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] Result<data::Table> parse_table(std::string_view text, std::string_view name);

/// Whether rotational columns are in degrees: as stated in the file, else the convention of its kind: degrees
/// under a SIMM header (datacolumns or datarows), radians elsewhere.
[[nodiscard]] bool angles_are_degrees(const data::Table& table);

/// Options of write_table().
struct TableWriteOptions {
  bool force = false;  ///< replace a file that exists
  int version = 1;     ///< 1 (read by every OpenSim) or 3
  int decimals = -1;   ///< digits after the point, 0 to 17; -1: the shortest that read back exactly
  std::string set;     ///< that the file belongs to: then it names it and holds its own checksum; empty: none
};

/// Write a table as OpenSim reads it. Header lines that the table carries are kept, except those that count,
/// version, name a set or sum up; inDegrees is written as angles_are_degrees(), and left out where it is no
/// and the input did not state it. An empty name becomes the file's. Code::bad_input when the table is
/// invalid or a name holds a tab or line end; Code::io as OutputFile.
[[nodiscard]] Status write_table(const std::filesystem::path& path, const data::Table& table,
                                 const TableWriteOptions& options = {});

}  // namespace kinemark::io
