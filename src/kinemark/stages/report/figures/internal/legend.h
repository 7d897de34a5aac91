// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Names beside how they are drawn, in lines as wide as there is room.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/stages/report/figures/canvas.h"
#include "kinemark/stages/report/figures/figure.h"

namespace kinemark::report::internal {

// Pixels that a text takes at a size, as far as that can be told without its font.
[[nodiscard]] double text_width(std::string_view text, double size);

// A text in lines of at most so many pixels, broken at blanks.
[[nodiscard]] std::vector<std::string> broken_text(std::string_view text, double size, double width);

// Names and how they look, each on its place.
class Legend {
 public:
  // What of the panel has a name. Names go below each other where they do not fit into the width.
  Legend(const FigurePanel& panel, double width);
  // The same of a figure's keys.
  Legend(const std::vector<FigureKey>& keys, double width);

  [[nodiscard]] double height() const { return height_; }  // pixels; 0 without names
  void draw(Canvas& canvas, const Eigen::Vector2d& corner) const;

 private:
  enum class Look : std::uint8_t { line, area, symbol };
  struct Entry {
    std::string name;
    Look look = Look::line;
    Stroke stroke;
    double opacity = 1.0;
    SymbolShape shape = SymbolShape::disc;
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
  };
  void lay_out(double width);

  std::vector<Entry> entries_;
  double height_ = 0.0;
};

// A symbol. Contract: `direction` of an arrow is not 0.
void draw_symbol(Canvas& canvas, SymbolShape shape, const Eigen::Vector2d& at,
                 const Eigen::Vector2d& direction, const std::string& colour);

}  // namespace kinemark::report::internal
