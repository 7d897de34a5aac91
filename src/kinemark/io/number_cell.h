// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Numbers as people and countries write them into the cells of a table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinemark::io {

/// What a cell is as a number. Three digits behind a comma or a point may be a part of one, or thousands.
enum class Number : std::uint8_t {
  none,
  whole,
  with_point,
  with_comma,
  three_behind_point,  ///< "1.234"
  three_behind_comma,  ///< "1,234"
  groups_with_commas,  ///< "1,234.5", "1,234,567"
  groups_with_points,  ///< "1.234,5", "1.234.567"
};

/// True of 0 to 9.
[[nodiscard]] inline bool is_decimal(char c) { return c >= '0' && c <= '9'; }

/// What a cell is, without blanks around it.
[[nodiscard]] Number number_in(std::string_view cell);

/// A cell with the signs of typesetters and of other countries brought to those of programs: a minus of its
/// own, blanks and apostrophes between groups of three digits ("1 234,5", "1'234.5"), the D of Fortran's
/// exponents.
[[nodiscard]] std::string with_usual_signs(std::string_view cell);

/// How often each kind of number stands in a text, and in its columns numbers that may be thousands.
class NumberKinds {
 public:
  /// Counts a row: what each cell is, and its text.
  void add(const std::vector<std::pair<Number, std::string>>& row);

  /// Which of ',' and '.' stands between thousands; 0: none, or what is there contradicts both.
  [[nodiscard]] char thousands() const;
  /// Whether a comma stands before the parts of one.
  [[nodiscard]] bool have_decimal_commas() const;

 private:
  struct Column {
    double whole = 0.0;                     // largest number without comma and point
    double by_point = 0.0, by_comma = 0.0;  // largest "1.234" as 1.234, and "1,234"
  };

  [[nodiscard]] std::size_t of(Number kind) const { return count_[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] bool are_thousands(double Column::* three) const;

  std::array<std::size_t, 8> count_{};
  std::vector<Column> columns_;
};

}  // namespace kinemark::io
