// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/figure.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/stages/report/figures/canvas.h"
#include "kinemark/stages/report/figures/plot_axis.h"

namespace kinemark::report {
namespace {

constexpr double kWidth = 640.0, kLeft = 72.0, kRight = 20.0, kTitle = 34.0, kCaption = 30.0;
constexpr double kPanelTop = 26.0, kPanelBottom = 44.0, kPlain = 210.0, kSquare = 400.0;  // heights
constexpr double kLegendLine = 16.0, kLetter = 6.6;                                       // a letter's width
constexpr double kPngScale = 3.0;
const std::string kInk = "#1a1a1a", kGrid = "#e3e3e3", kFrame = "#6b6b6b";

using Points = std::vector<Eigen::Vector2d>;

// A number on an axis, with the minus sign of print.
std::string tick_text(double value) {
  return value < 0.0 ? fmt::format("\u2212{:.6g}", -value) : fmt::format("{:.6g}", value);
}

double inner_height(const FigurePanel& panel) { return panel.equal ? kSquare : kPlain; }

// A name and how its line or band looks.
struct Entry {
  std::string name;
  Stroke stroke;
  bool band = false;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
};

// Names beside each other, and below where they do not fit; how many lines they take.
std::vector<Entry> legend_of(const FigurePanel& panel, double& lines) {
  std::vector<Entry> out;
  for (const auto& band : panel.bands)
    if (!band.name.empty())
      out.push_back({.name = band.name, .stroke = {.colour = band.colour}, .band = true});
  for (const auto& line : panel.lines)
    if (!line.name.empty())
      out.push_back(
          {.name = line.name, .stroke = {.colour = line.colour, .width = 2.0, .dashed = line.dashed}});
  Eigen::Vector2d at(kLeft, 0.0);
  for (auto& entry : out) {
    const double width = 42.0 + kLetter * static_cast<double>(entry.name.size());
    if (at.x() + width > kWidth - kRight && at.x() > kLeft) at = {kLeft, at.y() + kLegendLine};
    entry.at = at;
    at.x() += width;
  }
  lines = out.empty() ? 0.0 : at.y() / kLegendLine + 1.0;
  return out;
}

double legend_height(const FigurePanel& panel) {
  double lines = 0.0;
  (void)legend_of(panel, lines);
  return lines * kLegendLine;
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

/// One panel on its place.
class PanelDrawing {
 public:
  PanelDrawing(const FigurePanel& panel, double top, Canvas& canvas) : panel_(panel), canvas_(canvas) {
    x_ = {.from = kLeft, .to = kWidth - kRight};
    const double above = top + kPanelTop + legend_height(panel);
    y_ = {.from = above + inner_height(panel), .to = above};
    for (const auto& band : panel.bands) include(band.x, band.low), include(band.x, band.high);
    for (const auto& line : panel.lines) include(line.x, line.y);
    for (const auto& dot : panel.dots) x_.include(dot.x()), y_.include(dot.y());
    x_.settle();
    y_.settle();
    if (panel.equal) make_equal(x_, y_);
    top_ = top;
  }

  void draw() {
    draw_grid();
    for (const auto& band : panel_.bands) draw_band(band);
    for (const auto& line : panel_.lines) draw_line(line);
    for (const auto& dot : panel_.dots) canvas_.dot(place(dot.x(), dot.y()), 2.2, kInk);
    for (const auto& mark : panel_.marks) draw_mark(mark);
    canvas_.line(Points{{x_.from, y_.to}, {x_.from, y_.from}, {x_.to, y_.from}},
                 {.colour = kFrame, .width = 1.0});
    draw_legend();
    canvas_.text({0.5 * (x_.from + x_.to), y_.from + 36.0}, panel_.x_label,
                 {.anchor = Anchor::middle, .colour = kInk});
    canvas_.text({18.0, 0.5 * (y_.from + y_.to)}, panel_.y_label,
                 {.anchor = Anchor::middle, .colour = kInk, .upwards = true});
  }

 private:
  void include(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
    check(x.size() == y.size(), "a curve has as many x as y");
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (x_.shows(x[i]) && y_.shows(y[i])) x_.include(x[i]), y_.include(y[i]);
  }
  [[nodiscard]] Eigen::Vector2d place(double x, double y) const { return {x_.at(x), y_.at(y)}; }

  void draw_grid() {
    for (const double v : x_.ticks()) {
      canvas_.line(Points{{x_.at(v), y_.from}, {x_.at(v), y_.to}}, {.colour = kGrid, .width = 1.0});
      canvas_.text({x_.at(v), y_.from + 17.0}, tick_text(v),
                   {.size = 11.0, .anchor = Anchor::middle, .colour = kInk});
    }
    for (const double v : y_.ticks(panel_.equal ? 6.0 : 4.0)) {
      canvas_.line(Points{{x_.from, y_.at(v)}, {x_.to, y_.at(v)}}, {.colour = kGrid, .width = 1.0});
      canvas_.text({x_.from - 7.0, y_.at(v) + 4.0}, tick_text(v),
                   {.size = 11.0, .anchor = Anchor::end, .colour = kInk});
    }
  }
  void draw_band(const FigureBand& band) {
    const auto shown = [&](Eigen::Index i) {
      return x_.shows(band.x[i]) && y_.shows(band.low[i]) && y_.shows(band.high[i]);
    };
    for_each_run(band.x.size(), shown, [&](Eigen::Index begin, Eigen::Index end) {
      Points points;
      for (Eigen::Index i = begin; i < end; ++i) points.push_back(place(band.x[i], band.high[i]));
      for (Eigen::Index i = end; i-- > begin;) points.push_back(place(band.x[i], band.low[i]));
      canvas_.area(points, band.colour, 0.2);
    });
  }
  void draw_line(const FigureLine& line) {
    const auto shown = [&](Eigen::Index i) { return x_.shows(line.x[i]) && y_.shows(line.y[i]); };
    for_each_run(line.x.size(), shown, [&](Eigen::Index begin, Eigen::Index end) {
      Points points;
      for (Eigen::Index i = begin; i < end; ++i) points.push_back(place(line.x[i], line.y[i]));
      canvas_.line(points, {.colour = line.colour, .width = line.width, .dashed = line.dashed});
    });
  }
  void draw_mark(const FigureMark& mark) {
    if (!x_.shows(mark.x) || mark.x < x_.low || mark.x > x_.high) return;
    const double at = x_.at(mark.x);
    canvas_.line(Points{{at, y_.from}, {at, y_.to}}, {.colour = kFrame, .width = 1.0, .dashed = true});
    canvas_.text({at, y_.to - 5.0}, mark.name, {.size = 11.0, .anchor = Anchor::middle, .colour = kInk});
  }
  void draw_legend() {
    double lines = 0.0;
    for (const auto& entry : legend_of(panel_, lines)) {
      const double y = top_ + 10.0 + entry.at.y(), x = entry.at.x();
      if (entry.band)
        canvas_.area(Points{{x, y - 5.0}, {x + 22.0, y - 5.0}, {x + 22.0, y + 5.0}, {x, y + 5.0}},
                     entry.stroke.colour, 0.2);
      else
        canvas_.line(Points{{x, y}, {x + 22.0, y}}, entry.stroke);
      canvas_.text({x + 28.0, y + 4.0}, entry.name, {.colour = kInk});
    }
  }

  const FigurePanel& panel_;
  Canvas& canvas_;
  PlotAxis x_, y_;
  double top_ = 0.0;
};

double title_height(const Figure& figure) { return figure.title.empty() ? 6.0 : kTitle; }

double height_of(const Figure& figure) {
  double height = title_height(figure) + (figure.caption.empty() ? 8.0 : kCaption);
  for (const auto& panel : figure.panels)
    height += kPanelTop + legend_height(panel) + inner_height(panel) + kPanelBottom;
  return height;
}

void draw(const Figure& figure, Canvas& canvas) {
  if (!figure.title.empty()) canvas.text({kLeft, 22.0}, figure.title, {.size = 14.0, .colour = kInk});
  double top = title_height(figure);
  for (const auto& panel : figure.panels) {
    PanelDrawing(panel, top, canvas).draw();
    top += kPanelTop + legend_height(panel) + inner_height(panel) + kPanelBottom;
  }
  if (!figure.caption.empty())
    canvas.text({kLeft, top + 14.0}, figure.caption, {.size = 11.0, .colour = kFrame});
}

}  // namespace

std::string figure_svg(const Figure& figure) {
  const auto canvas = make_svg_canvas(kWidth, height_of(figure), figure.title);
  draw(figure, *canvas);
  return *canvas->finish();
}

Result<std::string> figure_png(const Figure& figure) {
  auto canvas = make_png_canvas(kWidth, height_of(figure), kPngScale);
  if (!canvas) return std::unexpected(canvas.error());
  draw(figure, **canvas);
  return (*canvas)->finish();
}

}  // namespace kinemark::report
