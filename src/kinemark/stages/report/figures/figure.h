// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Figures for print: panels below or beside each other, with axes, areas, bands, lines, marks and symbols.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stages/report/figures/canvas.h"

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
  bool dotted = false;   ///< instead of either
};

/// An area between two curves, broken where one of them is not finite.
struct FigureBand {
  std::string name;              ///< in the legend; empty: not there
  std::string colour;            ///< "#rrggbb", drawn at a fifth
  Eigen::VectorXd x, low, high;  ///< of equal size
  double opacity = 0.2;          ///< 0 to 1
};

/// A filled polygon.
struct FigureArea {
  std::string name;      ///< in the legend; empty: not there
  std::string colour;    ///< "#rrggbb", opaque
  Eigen::VectorXd x, y;  ///< corners, of equal size, all finite
};

/// A vertical line at an instant, with its name on top.
struct FigureMark {
  std::string name;    ///< may be empty
  double x = 0.0;      ///< where
  std::string colour;  ///< "#rrggbb"; empty: grey
  bool dashed = true;  ///< instead of drawn through
};

/// How a place is marked.
enum class SymbolShape : std::uint8_t {
  disc,   ///< filled
  ring,   ///< white inside
  arrow,  ///< its tip at the place, along `towards`
};

/// A place on a curve.
struct FigureSymbol {
  SymbolShape shape = SymbolShape::disc;               ///< how it looks
  std::string name;                                    ///< in the legend; empty: not there
  std::string colour;                                  ///< "#rrggbb"
  Eigen::Vector2d at{0.0, 0.0};                        ///< where; not finite: not drawn
  Eigen::Vector2d towards = Eigen::Vector2d::UnitX();  ///< of an arrow, in units of the axes
};

/// One pair of axes and what is drawn in it.
struct FigurePanel {
  std::string title;             ///< above it; empty: none
  std::string note;              ///< small, below its title; empty: none
  std::string x_label, y_label;  ///< with units in brackets
  std::string y_up, y_down;      ///< what the ends of the vertical axis mean: "flexion", "extension"
  bool equal = false;            ///< a unit is as long on both axes
  bool tight = false;            ///< the horizontal axis ends where its curves do
  bool zero = false;             ///< a darker line at 0
  bool blank = false;            ///< a place in the grid that stays free
  bool logarithmic = false;      ///< the vertical axis; what is not positive is left out
  double height = 0.0;           ///< pixels between its axes; 0: the figure's. The highest of a row counts
  /// Draws what stands in the place of axes and curves, such as a SpaceDrawing; empty: these.
  std::function<void(Canvas& canvas, const CanvasRoom& room)> picture;
  std::vector<FigureArea> areas;      ///< below all else
  std::vector<FigureBand> bands;      ///< above them
  std::vector<FigureLine> lines;      ///< in this order
  std::vector<FigureMark> marks;      ///< above them
  std::vector<FigureSymbol> symbols;  ///< above all
  std::vector<Eigen::Vector2d> dots;  ///< small, black
  std::vector<Eigen::Vector2d> room;  ///< places that the axes reach, where nothing is drawn
};

/// What a figure's own legend shows, once for all panels.
struct FigureKey {
  std::string name;      ///< in words
  std::string colour;    ///< "#rrggbb"
  bool band = false;     ///< an area instead of a line
  bool dashed = false;   ///< of a line
  bool dotted = false;   ///< of a line
  double width = 2.0;    ///< of a line, pixels
  double opacity = 0.2;  ///< of a band
};

/// A figure.
struct Figure {
  std::string title;                ///< on top; empty: none
  std::string caption;              ///< below, one line
  std::vector<FigurePanel> panels;  ///< row by row
  double width = 640.0;             ///< pixels
  std::int64_t columns = 1;         ///< of panels, at least 1
  double panel_height = 0.0;        ///< pixels between the axes; 0: as fits
  std::vector<FigureKey> keys;      ///< legend above the panels
  std::vector<std::string> notes;   ///< below the caption, broken into lines as is needed
};

/// A colour on white paper, as it looks with this share of its own: 1 is the colour, 0 is white.
[[nodiscard]] std::string tint(std::string_view colour, double share);

/// The figure as SVG, its letters as letters, for papers and pages. Contract: sizes agree.
[[nodiscard]] std::string figure_svg(const Figure& figure);

/// The figure as PNG, three dots a pixel: 640 pixels are 300 dots an inch at 16 cm. Code::not_supported as
/// make_png_canvas().
[[nodiscard]] Result<std::string> figure_png(const Figure& figure);

}  // namespace kinemark::report
