// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/svg_plot.h"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/html_text.h"
#include "kinemark/stages/report/figures/plot_axis.h"

namespace kinemark::studies {
namespace {

using report::PlotAxis;

constexpr double kWidth = 640.0, kHeight = 400.0, kLeft = 64.0, kRight = 16.0, kTop = 30.0, kBottom = 46.0,
                 kLegendLine = 14.0;

std::string text(double x, double y, const char* anchor, const std::string& label) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor,
                     html_text(label));
}

std::string ticks(const PlotAxis& x, const PlotAxis& y) {
  std::string out;
  const auto name = [](double v) { return fmt::format("{:.6g}", v); };
  for (const double v : x.ticks())
    out += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" class=\"grid\"/>", x.at(v), y.from, y.to) +
           text(x.at(v), y.from + 16.0, "middle", name(v));
  for (const double v : y.ticks())
    out += fmt::format("<path d=\"M{0:.1f} {1:.1f}H{2:.1f}\" class=\"grid\"/>", x.from, y.at(v), x.to) +
           text(x.from - 6.0, y.at(v) + 4.0, "end", name(v));
  return out;
}

}  // namespace

SvgPlot::SvgPlot(std::string title, std::string x_label, std::string y_label, bool equal)
    : title_(std::move(title)), x_label_(std::move(x_label)), y_label_(std::move(y_label)), equal_(equal) {}

void SvgPlot::line(std::string name, std::string colour, const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                   double width, bool dashed) {
  check(x.size() == y.size(), "a line has as many x as y");
  lines_.push_back({std::move(name), std::move(colour), x, y, width, dashed});
}

void SvgPlot::dots(std::string colour, const Eigen::VectorXd& x, const Eigen::VectorXd& y, double radius) {
  check(x.size() == y.size(), "dots have as many x as y");
  dots_.push_back({std::move(colour), x, y, radius});
}

void SvgPlot::box(const Eigen::Vector2d& low, const Eigen::Vector2d& high) { boxes_.emplace_back(low, high); }

std::string SvgPlot::svg() const {
  // Names that do not fit beside each other go below each other, and the plot begins further down.
  std::vector<Eigen::Vector2d> legend;
  Eigen::Vector2d position(kLeft, kTop - 12.0);
  for (const auto& l : lines_) {
    const double width = l.name.empty() ? 0.0 : 40.0 + 7.0 * static_cast<double>(l.name.size());
    if (position.x() + width > kWidth && position.x() > kLeft) position = {kLeft, position.y() + kLegendLine};
    legend.push_back(position);
    position.x() += width;
  }
  PlotAxis x{.from = kLeft, .to = kWidth - kRight}, y{.from = kHeight - kBottom, .to = position.y() + 12.0};
  y.logarithmic = log_y_;
  const auto include = [&](const Eigen::VectorXd& xs, const Eigen::VectorXd& ys) {
    for (Eigen::Index i = 0; i < xs.size(); ++i)
      if (x.shows(xs[i]) && y.shows(ys[i])) x.include(xs[i]), y.include(ys[i]);
  };
  for (const auto& l : lines_) include(l.x, l.y);
  for (const auto& d : dots_) include(d.x, d.y);
  for (const auto& [low, high] : boxes_)
    for (const auto& corner : {low, high}) x.include(corner.x()), y.include(corner.y());
  x.settle();
  y.settle();
  if (equal_) make_equal(x, y);
  std::string out =
      fmt::format("<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\"><title>{2}</title>",
                  kWidth, kHeight, html_text(title_));
  out += ticks(x, y);
  out += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}H{3:.1f}\" class=\"axis\"/>", x.from, y.to, y.from,
                     x.to);
  for (const auto& [low, high] : boxes_)
    out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" class=\"box\"/>",
                       x.at(low.x()), y.at(high.y()), x.at(high.x()) - x.at(low.x()),
                       y.at(low.y()) - y.at(high.y()));
  for (std::size_t line = 0; line < lines_.size(); ++line) {
    const auto& l = lines_[line];
    const char* dashes = l.dashed ? " stroke-dasharray=\"6 4\"" : "";
    out += fmt::format("<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{} d=\"", l.colour, l.width,
                       dashes);
    bool pen = false;
    for (Eigen::Index i = 0; i < l.x.size(); ++i) {
      const bool finite = x.shows(l.x[i]) && y.shows(l.y[i]);
      if (finite) out += fmt::format("{}{:.1f} {:.1f}", pen ? 'L' : 'M', x.at(l.x[i]), y.at(l.y[i]));
      pen = finite;
    }
    out += "\"/>";
    if (l.name.empty()) continue;
    out += fmt::format("<path d=\"M{:.1f} {:.1f}h16\" stroke=\"{}\" stroke-width=\"2\"{}/>", legend[line].x(),
                       legend[line].y(), l.colour, dashes) +
           text(legend[line].x() + 20.0, legend[line].y() + 4.0, "start", l.name);
  }
  for (const auto& d : dots_)
    for (Eigen::Index i = 0; i < d.x.size(); ++i)
      if (x.shows(d.x[i]) && y.shows(d.y[i]))
        out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>", x.at(d.x[i]),
                           y.at(d.y[i]), d.radius, d.colour);
  out += text(0.5 * (kLeft + kWidth - kRight), kHeight - 8.0, "middle", x_label_);
  out += fmt::format(
      "<text transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text></svg>",
      0.5 * (y.to + y.from), html_text(y_label_));
  return out;
}

}  // namespace kinemark::studies
