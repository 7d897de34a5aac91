// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Figures for print: panels below each other, with axes, lines, bands, marks and dots.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::report {

/// Colours that are told apart with every kind of colour vision (Okabe & Ito 2008), in the order of their
/// use.
inline constexpr std::string_view kFigureColours[] = {"#0072b2", "#d55e00", "#009e73",
                                                      "#cc79a7", "#e69f00", "#56b4e9"};

/// A line through the finite ones of its points, broken where one is not.
struct FigureLine {
  std::string name;      ///< in the legend; empty: not there
  std::string colour;    ///< "#rrggbb"
  Eigen::VectorXd x, y;  ///< of equal size
  double width = 1.4;    ///< pixels
  bool dashed = false;   ///< instead of drawn through
};

/// An area between two curves, broken where one of them is not finite.
struct FigureBand {
  std::string name;              ///< in the legend; empty: not there
  std::string colour;            ///< "#rrggbb", drawn at a fifth
  Eigen::VectorXd x, low, high;  ///< of equal size
};

/// A vertical line at an instant, with its name on top.
struct FigureMark {
  std::string name;  ///< may be empty
  double x = 0.0;    ///< where
};

/// One pair of axes and what is drawn in it.
struct FigurePanel {
  std::string x_label, y_label;       ///< with units in brackets
  bool equal = false;                 ///< a unit is as long on both axes
  std::vector<FigureBand> bands;      ///< below all else
  std::vector<FigureLine> lines;      ///< in this order
  std::vector<FigureMark> marks;      ///< above them
  std::vector<Eigen::Vector2d> dots;  ///< small, black
};

/// A figure, 640 pixels wide.
struct Figure {
  std::string title;                ///< on top; empty: none
  std::string caption;              ///< below, one line
  std::vector<FigurePanel> panels;  ///< below each other
};

/// The figure as SVG, its letters as letters, for papers and pages. Contract: sizes agree.
[[nodiscard]] std::string figure_svg(const Figure& figure);

/// The figure as PNG, 1,920 dots wide: 300 a inch at 16 cm. Code::not_supported as make_png_canvas().
[[nodiscard]] Result<std::string> figure_png(const Figure& figure);

}  // namespace kinemark::report
