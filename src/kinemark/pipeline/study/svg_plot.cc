// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/study/svg_plot.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/check.h"

namespace kinemark::pipeline {
namespace {

constexpr double kWidth = 640.0, kHeight = 400.0, kLeft = 64.0, kRight = 16.0, kTop = 30.0, kBottom = 46.0;

/// A range of one axis and where it lies on the picture.
struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  double from = 0.0, to = 1.0;  // pixels of low and high

  void include(double v) {
    if (!std::isfinite(v)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  void settle() {
    if (!(low <= high)) low = 0.0, high = 1.0;
    const double margin = high > low ? 0.04 * (high - low) : 0.5;
    low -= margin;
    high += margin;
  }
  [[nodiscard]] double at(double v) const { return from + (v - low) / (high - low) * (to - from); }
  /// 1, 2 or 5 times a power of ten, so that about six ticks fit.
  [[nodiscard]] double tick() const {
    const double raw = (high - low) / 6.0, power = std::pow(10.0, std::floor(std::log10(raw)));
    for (const double m : {1.0, 2.0, 5.0})
      if (m * power >= raw) return m * power;
    return 10.0 * power;
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

std::string text(double x, double y, const char* anchor, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor, words);
}

std::string ticks(const Axis& x, const Axis& y) {
  std::string out;
  const auto name = [](double v, double step) {
    return fmt::format("{:.6g}", std::abs(v) < 1e-9 * step ? 0.0 : v);
  };
  for (double step = x.tick(), v = std::ceil(x.low / step) * step; v <= x.high; v += step)
    out += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" class=\"grid\"/>", x.at(v), y.from, y.to) +
           text(x.at(v), y.from + 16.0, "middle", name(v, step));
  for (double step = y.tick(), v = std::ceil(y.low / step) * step; v <= y.high; v += step)
    out += fmt::format("<path d=\"M{0:.1f} {1:.1f}H{2:.1f}\" class=\"grid\"/>", x.from, y.at(v), x.to) +
           text(x.from - 6.0, y.at(v) + 4.0, "end", name(v, step));
  return out;
}

}  // namespace

SvgPlot::SvgPlot(std::string title, std::string x_label, std::string y_label, bool equal)
    : title_(std::move(title)), x_label_(std::move(x_label)), y_label_(std::move(y_label)), equal_(equal) {}

void SvgPlot::line(std::string name, std::string colour, const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                   double width) {
  check(x.size() == y.size(), "a line has as many x as y");
  lines_.push_back({std::move(name), std::move(colour), x, y, width});
}

void SvgPlot::box(const Eigen::Vector2d& low, const Eigen::Vector2d& high) { boxes_.emplace_back(low, high); }

std::string SvgPlot::svg() const {
  Axis x{.from = kLeft, .to = kWidth - kRight}, y{.from = kHeight - kBottom, .to = kTop};
  for (const auto& l : lines_)
    for (Eigen::Index i = 0; i < l.x.size(); ++i)
      if (std::isfinite(l.x[i]) && std::isfinite(l.y[i])) x.include(l.x[i]), y.include(l.y[i]);
  for (const auto& [low, high] : boxes_)
    for (const auto& corner : {low, high}) x.include(corner.x()), y.include(corner.y());
  x.settle();
  y.settle();
  if (equal_) make_equal(x, y);
  std::string out =
      fmt::format("<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\"><title>{2}</title>",
                  kWidth, kHeight, title_);
  out += ticks(x, y);
  for (const auto& [low, high] : boxes_)
    out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" class=\"box\"/>",
                       x.at(low.x()), y.at(high.y()), x.at(high.x()) - x.at(low.x()),
                       y.at(low.y()) - y.at(high.y()));
  double legend = kLeft;
  for (const auto& l : lines_) {
    out += fmt::format("<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" d=\"", l.colour, l.width);
    bool pen = false;
    for (Eigen::Index i = 0; i < l.x.size(); ++i) {
      const bool finite = std::isfinite(l.x[i]) && std::isfinite(l.y[i]);
      if (finite) out += fmt::format("{}{:.1f} {:.1f}", pen ? 'L' : 'M', x.at(l.x[i]), y.at(l.y[i]));
      pen = finite;
    }
    out += "\"/>";
    if (l.name.empty()) continue;
    out += fmt::format("<path d=\"M{:.1f} {:.1f}h16\" stroke=\"{}\" stroke-width=\"2\"/>", legend,
                       kTop - 12.0, l.colour) +
           text(legend + 20.0, kTop - 8.0, "start", l.name);
    legend += 40.0 + 7.0 * static_cast<double>(l.name.size());
  }
  out += text(0.5 * (kLeft + kWidth - kRight), kHeight - 8.0, "middle", x_label_);
  out += fmt::format(
      "<text transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text></svg>",
      0.5 * (kTop + kHeight - kBottom), y_label_);
  return out;
}

}  // namespace kinemark::pipeline
