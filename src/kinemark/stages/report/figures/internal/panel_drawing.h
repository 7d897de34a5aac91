// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One pair of axes on its place in a figure.
#pragma once

#include <Eigen/Core>
#include <string>

#include "kinemark/stages/report/figures/canvas.h"
#include "kinemark/stages/report/figures/figure.h"
#include "kinemark/stages/report/figures/plot_axis.h"

namespace kinemark::report::internal {

// Pixels of a picture between which a panel's axes run, and how large its letters are.
struct PanelFrame {
  double left = 0.0, right = 0.0;  // of the axes
  double top = 0.0, bottom = 0.0;  // of the axes
  double label_left = 0.0;         // baseline of the vertical axis's label
  double label_below = 36.0;       // from the horizontal axis down to its label's baseline
  double tick_size = 11.0;         // of numbers on the axes
  double label_size = 12.0;        // of labels
};

// Draws a panel; its title, note and legend are the figure's business.
class PanelDrawing {
 public:
  // Contract: sizes of curves agree.
  PanelDrawing(const FigurePanel& panel, const PanelFrame& frame, Canvas& canvas);
  void draw();

 private:
  void include(const Eigen::VectorXd& x, const Eigen::VectorXd& y);
  [[nodiscard]] Eigen::Vector2d place(double x, double y) const { return {x_.at(x), y_.at(y)}; }
  void draw_grid();
  void draw_area(const FigureArea& area);
  void draw_band(const FigureBand& band);
  void draw_line(const FigureLine& line);
  void draw_mark(const FigureMark& mark);
  void draw_symbol_at(const FigureSymbol& symbol);
  void draw_labels();

  const FigurePanel& panel_;
  PanelFrame frame_;
  Canvas& canvas_;
  PlotAxis x_, y_;
};

}  // namespace kinemark::report::internal
