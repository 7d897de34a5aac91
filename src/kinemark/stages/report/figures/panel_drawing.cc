// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/internal/panel_drawing.h"

#include <fmt/core.h>

#include <cmath>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/stages/report/figures/internal/legend.h"

namespace kinemark::report::internal {
namespace {

const std::string kInk = "#1a1a1a", kGrid = "#e3e3e3", kFrame = "#6b6b6b", kZero = "#a8a8a8";
constexpr double kPixelsPerTick = 30.0;    // of the vertical axis
constexpr double kPixelsPerColumn = 42.0;  // of the horizontal one

using Points = std::vector<Eigen::Vector2d>;

// A number on an axis, with the minus sign of print.
std::string tick_text(double value) {
  return value < 0.0 ? fmt::format("\u2212{:.6g}", -value) : fmt::format("{:.6g}", value);
}

// Calls visit(begin, end) for every run of points that are shown.
template <class Shown, class Visit>
void for_each_run(Eigen::Index count, const Shown& shown, const Visit& visit) {
  for (Eigen::Index i = 0; i < count;) {
    while (i < count && !shown(i)) ++i;
    const Eigen::Index begin = i;
    while (i < count && shown(i)) ++i;
    if (i > begin) visit(begin, i);
  }
}

}  // namespace

PanelDrawing::PanelDrawing(const FigurePanel& panel, const PanelFrame& frame, Canvas& canvas)
    : panel_(panel), frame_(frame), canvas_(canvas) {
  x_ = {.from = frame.left, .to = frame.right};
  y_ = {.from = frame.bottom, .to = frame.top, .logarithmic = panel.logarithmic};
  for (const auto& area : panel.areas) include(area.x, area.y);
  for (const auto& band : panel.bands) include(band.x, band.low), include(band.x, band.high);
  for (const auto& line : panel.lines) include(line.x, line.y);
  for (const auto& dot : panel.dots) x_.include(dot.x()), y_.include(dot.y());
  for (const auto& place : panel.room) x_.include(place.x()), y_.include(place.y());
  const PlotAxis seen = x_;
  x_.settle();
  y_.settle();
  if (panel.tight && seen.low < seen.high) x_.low = seen.low, x_.high = seen.high;
  if (panel.equal) make_equal(x_, y_);
}

void PanelDrawing::draw() {
  draw_grid();
  for (const auto& area : panel_.areas) draw_area(area);
  for (const auto& band : panel_.bands) draw_band(band);
  if (panel_.zero && y_.low < 0.0 && y_.high > 0.0)
    canvas_.line(Points{{x_.from, y_.at(0.0)}, {x_.to, y_.at(0.0)}}, {.colour = kZero, .width = 1.0});
  for (const auto& line : panel_.lines) draw_line(line);
  for (const auto& dot : panel_.dots) canvas_.dot(place(dot.x(), dot.y()), 2.2, kInk);
  for (const auto& mark : panel_.marks) draw_mark(mark);
  canvas_.line(Points{{x_.from, y_.to}, {x_.from, y_.from}, {x_.to, y_.from}},
               {.colour = kFrame, .width = 1.0});
  for (const auto& symbol : panel_.symbols) draw_symbol_at(symbol);
  draw_labels();
}

void PanelDrawing::include(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  check(x.size() == y.size(), "a curve has as many x as y");
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (x_.shows(x[i]) && y_.shows(y[i])) x_.include(x[i]), y_.include(y[i]);
}

void PanelDrawing::draw_grid() {
  const double across = std::abs(x_.to - x_.from), up = std::abs(y_.to - y_.from);
  const bool wide = across > 400.0;
  for (const double v : x_.ticks(wide ? 6.0 : across / kPixelsPerColumn)) {
    canvas_.line(Points{{x_.at(v), y_.from}, {x_.at(v), y_.to}}, {.colour = kGrid, .width = 1.0});
    canvas_.text({x_.at(v), y_.from + 6.0 + frame_.tick_size}, tick_text(v),
                 {.size = frame_.tick_size, .anchor = Anchor::middle, .colour = kInk});
  }
  const double many = panel_.equal ? 6.0 : 4.0;
  for (const double v : y_.ticks(wide ? many : up / kPixelsPerTick)) {
    canvas_.line(Points{{x_.from, y_.at(v)}, {x_.to, y_.at(v)}}, {.colour = kGrid, .width = 1.0});
    canvas_.text({x_.from - 7.0, y_.at(v) + 0.37 * frame_.tick_size}, tick_text(v),
                 {.size = frame_.tick_size, .anchor = Anchor::end, .colour = kInk});
  }
}

void PanelDrawing::draw_area(const FigureArea& area) {
  Points points;
  for (Eigen::Index i = 0; i < area.x.size(); ++i) points.push_back(place(area.x[i], area.y[i]));
  canvas_.area(points, area.colour, 1.0);
}

void PanelDrawing::draw_band(const FigureBand& band) {
  const auto shown = [&](Eigen::Index i) {
    return x_.shows(band.x[i]) && y_.shows(band.low[i]) && y_.shows(band.high[i]);
  };
  for_each_run(band.x.size(), shown, [&](Eigen::Index begin, Eigen::Index end) {
    Points points;
    for (Eigen::Index i = begin; i < end; ++i) points.push_back(place(band.x[i], band.high[i]));
    for (Eigen::Index i = end; i-- > begin;) points.push_back(place(band.x[i], band.low[i]));
    canvas_.area(points, band.colour, band.opacity);
  });
}

void PanelDrawing::draw_line(const FigureLine& line) {
  const auto shown = [&](Eigen::Index i) { return x_.shows(line.x[i]) && y_.shows(line.y[i]); };
  for_each_run(line.x.size(), shown, [&](Eigen::Index begin, Eigen::Index end) {
    Points points;
    for (Eigen::Index i = begin; i < end; ++i) points.push_back(place(line.x[i], line.y[i]));
    canvas_.line(points,
                 {.colour = line.colour, .width = line.width, .dashed = line.dashed, .dotted = line.dotted});
  });
}

void PanelDrawing::draw_mark(const FigureMark& mark) {
  if (!x_.shows(mark.x) || mark.x < x_.low || mark.x > x_.high) return;
  const double at = x_.at(mark.x);
  canvas_.line(Points{{at, y_.from}, {at, y_.to}},
               {.colour = mark.colour.empty() ? kFrame : mark.colour, .width = 1.0, .dashed = mark.dashed});
  if (!mark.name.empty())
    canvas_.text({at, y_.to - 5.0}, mark.name,
                 {.size = frame_.tick_size, .anchor = Anchor::middle, .colour = kInk});
}

void PanelDrawing::draw_symbol_at(const FigureSymbol& symbol) {
  if (!x_.shows(symbol.at.x()) || !y_.shows(symbol.at.y())) return;
  const Eigen::Vector2d from = place(symbol.at.x(), symbol.at.y()),
                        to = place(symbol.at.x() + symbol.towards.x(), symbol.at.y() + symbol.towards.y());
  if (symbol.shape == SymbolShape::arrow && !((to - from).norm() > 0.0)) return;
  draw_symbol(canvas_, symbol.shape, from, to - from, symbol.colour);
}

void PanelDrawing::draw_labels() {
  if (!panel_.x_label.empty())
    canvas_.text({0.5 * (x_.from + x_.to), y_.from + frame_.label_below}, panel_.x_label,
                 {.size = frame_.label_size, .anchor = Anchor::middle, .colour = kInk});
  canvas_.text({frame_.label_left, 0.5 * (y_.from + y_.to)}, panel_.y_label,
               {.size = frame_.label_size, .anchor = Anchor::middle, .colour = kInk, .upwards = true});
  if (!panel_.y_up.empty())
    canvas_.text({frame_.label_left, y_.to}, panel_.y_up,
                 {.size = frame_.tick_size, .anchor = Anchor::end, .colour = kFrame, .upwards = true});
  if (!panel_.y_down.empty())
    canvas_.text({frame_.label_left, y_.from}, panel_.y_down,
                 {.size = frame_.tick_size, .anchor = Anchor::start, .colour = kFrame, .upwards = true});
}

}  // namespace kinemark::report::internal
