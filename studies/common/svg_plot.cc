// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/svg_plot.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/html_text.h"

namespace kinemark::studies {
namespace {

constexpr double kWidth = 640.0, kHeight = 400.0, kLeft = 64.0, kRight = 16.0, kTop = 30.0, kBottom = 46.0,
                 kLegendLine = 14.0;

/// A range of one axis and where it lies on the picture.
struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  double from = 0.0, to = 1.0;  // pixels of low and high
  bool logarithmic = false;     // low and high are logarithms to the base 10

  [[nodiscard]] bool shows(double v) const { return std::isfinite(v) && (!logarithmic || v > 0.0); }
  void include(double v) {
    if (!shows(v)) return;
    if (logarithmic) v = std::log10(v);
    low = std::min(low, v);
    high = std::max(high, v);
  }
  void settle() {
    if (!(low <= high)) low = 0.0, high = 1.0;
    const double margin = high > low ? 0.04 * (high - low) : 0.5;
    low -= margin;
    high += margin;
  }
  [[nodiscard]] double at(double v) const {
    return from + ((logarithmic ? std::log10(v) : v) - low) / (high - low) * (to - from);
  }
  /// 1, 2 or 5 times a power of ten, so that about six ticks fit.
  [[nodiscard]] double tick() const {
    const double raw = (high - low) / 6.0, power = std::pow(10.0, std::floor(std::log10(raw)));
    for (const double m : {1.0, 2.0, 5.0})
      if (m * power >= raw) return m * power;
    return 10.0 * power;
  }
  /// Where grid lines go.
  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> out;
    if (!logarithmic) {
      for (double step = tick(), v = std::ceil(low / step) * step; v <= high; v += step)
        out.push_back(std::abs(v) < 1e-9 * step ? 0.0 : v);
      return out;
    }
    for (double power = std::floor(low); power <= high; power += 1.0)
      for (const double m : {1.0, 2.0, 5.0}) {
        const double v = std::log10(m) + power;
        if (v >= low && v <= high) out.push_back(m * std::pow(10.0, power));
      }
    return out;
  }
};

/// Widen the axis that shows fewer units per pixel.
void make_equal(Axis& x, Axis& y) {
  const double x_scale = (x.high - x.low) / std::abs(x.to - x.from),
               y_scale = (y.high - y.low) / std::abs(y.to - y.from);
  Axis& narrow = x_scale < y_scale ? x : y;
  const double half = 0.5 * std::max(x_scale, y_scale) * std::abs(narrow.to - narrow.from),
               middle = 0.5 * (narrow.low + narrow.high);
  narrow.low = middle - half;
  narrow.high = middle + half;
}

std::string text(double x, double y, const char* anchor, const std::string& label) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor,
                     html_text(label));
}

std::string ticks(const Axis& x, const Axis& y) {
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
  Axis x{.from = kLeft, .to = kWidth - kRight}, y{.from = kHeight - kBottom, .to = position.y() + 12.0};
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
