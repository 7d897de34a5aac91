// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/screens/glyphs.h"
#include "kinemark/core/check.h"

namespace kinemark::screens {
namespace {

constexpr char32_t kNoDots = 0x2800;  // Unicode's braille pattern without a dot
// Bits of a braille pattern by row and column of its dots.
constexpr std::array<std::array<int, 2>, 4> kDots = {
    {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}}};

// Which of n steps over [-1, 1] a coordinate falls into; -1: none.
int step_of(double x, int n) {
  if (!(x >= -1.0 && x <= 1.0)) return -1;
  return std::min(static_cast<int>((x + 1.0) / 2.0 * n), n - 1);
}

}  // namespace

Canvas::Canvas(int rows, int columns) : rows_(std::max(rows, 0)), columns_(std::max(columns, 0)) {
  cells_.resize(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_));
}

const Cell& Canvas::at(int row, int column) const {
  check(row >= 0 && row < rows_ && column >= 0 && column < columns_, "a place on the canvas");
  return cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                static_cast<std::size_t>(column)];
}

void Canvas::put(int row, int column, char32_t glyph, Ink ink) {
  if (row < 0 || row >= rows_ || column < 0 || column >= columns_) return;
  cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
         static_cast<std::size_t>(column)] = {glyph, ink};
}

void Canvas::text(int row, int column, std::string_view utf8, Ink ink, int width) {
  std::u32string glyphs = glyphs_of(utf8);
  const auto most = static_cast<std::size_t>(std::clamp(width, 0, std::max(columns_ - column, 0)));
  if (glyphs.size() > most) {
    glyphs.resize(most);
    if (most > 0) glyphs.back() = U'\u2026';
  }
  for (std::size_t i = 0; i < glyphs.size(); ++i) put(row, column + static_cast<int>(i), glyphs[i], ink);
}

void Canvas::box(int row, int column, int rows, int columns, std::string_view title) {
  const int bottom = row + rows - 1, right = column + columns - 1;
  for (int c = column + 1; c < right; ++c) {
    put(row, c, U'\u2500', Ink::dim);
    put(bottom, c, U'\u2500', Ink::dim);
  }
  for (int r = row + 1; r < bottom; ++r) {
    put(r, column, U'\u2502', Ink::dim);
    put(r, right, U'\u2502', Ink::dim);
  }
  put(row, column, U'\u250C', Ink::dim);
  put(row, right, U'\u2510', Ink::dim);
  put(bottom, column, U'\u2514', Ink::dim);
  put(bottom, right, U'\u2518', Ink::dim);
  if (!title.empty()) text(row, column + 2, " " + std::string(title) + " ", Ink::bold, columns - 4);
}

void Canvas::dots(int row, int column, int rows, int columns, std::span<const Eigen::Vector2d> points,
                  Ink ink) {
  for (const Eigen::Vector2d& point : points) {
    const int x = step_of(point.x(), 2 * columns), y = step_of(point.y(), 4 * rows);
    if (x < 0 || y < 0 || row + y / 4 >= rows_ || column + x / 2 >= columns_) continue;
    const char32_t there = at(row + y / 4, column + x / 2).glyph;
    const int bit = kDots[static_cast<std::size_t>(y % 4)][static_cast<std::size_t>(x % 2)];
    put(row + y / 4, column + x / 2,
        (there >= kNoDots && there <= kNoDots + 0xFF ? there : kNoDots) | static_cast<char32_t>(bit), ink);
  }
}

void Canvas::bar(int row, int column, int width, double share) {
  if (std::isnan(share)) return;
  const int filled = static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * width));
  for (int i = 0; i < width; ++i)
    put(row, column + i, i < filled ? U'\u2588' : U'\u00B7', i < filled ? Ink::plain : Ink::dim);
}

std::string Canvas::to_text() const {
  std::string out;
  for (int row = 0; row < rows_; ++row) {
    std::string line;
    for (int column = 0; column < columns_; ++column) append_utf8(at(row, column).glyph, line);
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

}  // namespace kinemark::screens
