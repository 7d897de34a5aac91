// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A screen of characters in memory: what a terminal shows, and what tests read.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinemark::screens {

/// How a character is drawn. Never by colour alone: a word says the same.
enum class Ink : std::uint8_t { plain, bold, dim, chosen };

/// One character.
struct Cell {
  char32_t glyph = U' ';  ///< of width 1
  Ink ink = Ink::plain;   ///< how
};

/// Rows and columns of characters, blank at first. What lies outside is left out.
class Canvas {
 public:
  Canvas(int rows, int columns);
  [[nodiscard]] int rows() const { return rows_; }        ///< >= 0
  [[nodiscard]] int columns() const { return columns_; }  ///< >= 0
  [[nodiscard]] const Cell& at(int row, int column) const;
  /// A text from (row, column) to the right, `width` characters at most; one that is longer ends in "…".
  void text(int row, int column, std::string_view utf8, Ink ink = Ink::plain, int width = 1 << 20);
  /// A box of lines with a title in its upper edge. At least 2 x 2.
  void box(int row, int column, int rows, int columns, std::string_view title);
  /// Points in braille, 2 x 4 dots to a character, in the rectangle of that place and size; x to the right, y
  /// down, each in [-1, 1]. NaN and points outside are left out.
  void dots(int row, int column, int rows, int columns, std::span<const Eigen::Vector2d> points,
            Ink ink = Ink::plain);
  /// A bar of `width` characters, filled to a share in [0, 1]; NaN: blank.
  void bar(int row, int column, int width, double share);
  /// All rows, blanks at their ends cut, each with its line feed.
  [[nodiscard]] std::string to_text() const;

 private:
  void put(int row, int column, char32_t glyph, Ink ink);
  int rows_, columns_;
  std::vector<Cell> cells_;
};

}  // namespace kinemark::screens
