// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/text/internal/cells.h"

namespace kinemark::io::internal {

/// Everything of a MOT or STO file before its rows.
struct TableHeader {
  std::string name;
  std::vector<std::pair<std::string, std::string>> pairs;  ///< key and value; free text has an empty key
  std::optional<bool> in_degrees;
  std::optional<double> rows;     ///< nRows or datarows as written
  std::optional<double> columns;  ///< nColumns or datacolumns, time included
  std::size_t width = 1;          ///< numbers per cell (DataType=VecN, Quaternion)
  bool is_orientations = false;   ///< DataType=Quaternion
  Separator separator = Separator::tab;
  std::vector<std::string> columns_named;  ///< without time; width > 1: expanded
  std::vector<std::string> warnings;
};

/// True for keys that write_table() writes itself or drops because they described the old file ("nRows",
/// "range").
[[nodiscard]] bool is_written_by_us(std::string_view key);

/// Read up to the line of labels and the blank lines after it. Errors carry the line, not the file.
[[nodiscard]] Result<TableHeader> parse_table_header(Lines& lines);

}  // namespace kinemark::io::internal
