// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Numbers as people and countries write them into the cells of a table.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

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

}  // namespace kinemark::io
