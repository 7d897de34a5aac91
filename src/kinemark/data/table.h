// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"

namespace kinemark::data {

/// A table of named columns over time, as MOT and STO files hold: R rows, K columns besides time.
struct Table {
  std::string name;  ///< first line of the file; may be empty
  std::vector<std::pair<std::string, std::string>>
      header;                         ///< key and value, in file order, of all other header lines
  bool in_degrees = false;            ///< what the file said of its rotational columns; values are as written
  bool degrees_stated = true;         ///< false: the file said nothing, in_degrees is false and means nothing
  std::vector<std::string> columns;   ///< K names, time not among them
  Array<double> time_s;               ///< R, increasing
  Array<double> values;               ///< R x K, row first; NaN where the file has none
  std::vector<std::string> warnings;  ///< irregularities of the file, one sentence each

  [[nodiscard]] std::int64_t rows() const { return static_cast<std::int64_t>(time_s.size()); }  ///< R
  [[nodiscard]] std::int64_t find(std::string_view column) const;  ///< index of a column, or -1
  /// One cell; NaN where the file has none.
  [[nodiscard]] double operator()(std::int64_t row, std::int64_t column) const {
    return values[static_cast<std::size_t>(row) * columns.size() + static_cast<std::size_t>(column)];
  }
  /// Shapes agree, column names are unique, time increases.
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data
