// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/timing_diagram.h"

#include <fmt/core.h>

#include <algorithm>

#include "kinemark/stages/report/figures/plot_axis.h"

namespace kinemark::report {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

constexpr double kNames = 136.0, kRow = 40.0, kHigh = 24.0, kSpanRow = 22.0, kAxis = 46.0, kRight = 14.0;
const std::string kInk = "#1a1a1a", kThin = "#9a9a9a", kGuide = "#d4d4d4";

double width_of(const std::string& text) { return 6.2 * static_cast<double>(text.size()); }

/// Row of each span: the first in which it touches no other, its words included.
std::vector<int> rows_of(const TimingDiagram& diagram, const PlotAxis& time) {
  std::vector<int> out;
  std::vector<double> filled;  // of each row, pixels
  for (const auto& span : diagram.spans) {
    const double middle = 0.5 * (time.at(span.from) + time.at(span.to)),
                 half = 0.5 * width_of(span.text) + 4.0, from = std::min(time.at(span.from), middle - half),
                 to = std::max(time.at(span.to), middle + half);
    std::size_t row = 0;
    while (row < filled.size() && filled[row] > from) ++row;
    if (row == filled.size()) filled.push_back(0.0);
    filled[row] = to;
    out.push_back(static_cast<int>(row));
  }
  return out;
}

void draw_span(const TimingSpan& span, const PlotAxis& time, double y, Canvas& canvas) {
  constexpr double kHead = 5.0;
  const double a = time.at(span.from), b = time.at(span.to);
  canvas.line(Points{{a, y}, {b, y}}, {.colour = kInk, .width = 1.0});
  if (b - a > 3.0 * kHead)
    for (const auto& [tip, back] : {std::pair{a, a + kHead}, std::pair{b, b - kHead}})
      canvas.area(Points{{tip, y}, {back, y - 2.5}, {back, y + 2.5}}, kInk, 1.0);
  canvas.text({0.5 * (a + b), y + 13.0}, span.text,
              {.size = 11.0, .anchor = Anchor::middle, .colour = kInk, .halo = true});
}

PlotAxis axis_of(const TimingDiagram& diagram, double left, double right) {
  return {.low = diagram.begin, .high = diagram.end, .from = left + kNames, .to = right - kRight};
}

}  // namespace

double height_of(const TimingDiagram& diagram) {
  constexpr double kUsual = 624.0;  // of a figure of 640 pixels
  const auto rows = rows_of(diagram, axis_of(diagram, 0.0, kUsual));
  const int spans = rows.empty() ? 0 : std::ranges::max(rows) + 1;
  return kRow * static_cast<double>(diagram.traces.size()) + kSpanRow * spans + (spans > 0 ? 12.0 : 0.0) +
         kAxis;
}

void draw(const TimingDiagram& diagram, Canvas& canvas, const CanvasRoom& room) {
  const auto time = axis_of(diagram, room.left, room.right);
  const auto rows = rows_of(diagram, time);
  const double below = room.top + kRow * static_cast<double>(diagram.traces.size());
  for (std::size_t i = 0; i < diagram.spans.size(); ++i) {
    const double y = below + 12.0 + kSpanRow * rows[i];
    for (const double at : {diagram.spans[i].from, diagram.spans[i].to})
      canvas.line(Points{{time.at(at), room.top}, {time.at(at), y + 3.0}}, {.colour = kGuide, .width = 1.0});
  }
  for (std::size_t i = 0; i < diagram.traces.size(); ++i) {
    const auto& trace = diagram.traces[i];
    const double low = room.top + kRow * static_cast<double>(i + 1) - 6.0;
    canvas.text({time.from - 12.0, low - 7.0}, trace.name,
                {.size = 12.0, .anchor = Anchor::end, .colour = kInk});
    Points points;
    for (Eigen::Index k = 0; k < trace.time.size(); ++k)
      points.emplace_back(time.at(trace.time[k]), low - kHigh * trace.level[k]);
    canvas.line(points, {.colour = kInk, .width = trace.width});
  }
  for (std::size_t i = 0; i < diagram.spans.size(); ++i)
    draw_span(diagram.spans[i], time, below + 12.0 + kSpanRow * rows[i], canvas);
  const double y = room.bottom - kAxis + 8.0;
  canvas.line(Points{{time.from, y}, {time.to, y}}, {.colour = kThin, .width = 1.0});
  for (const double v : time.ticks()) {
    canvas.line(Points{{time.at(v), y}, {time.at(v), y + 4.0}}, {.colour = kThin, .width = 1.0});
    canvas.text({time.at(v), y + 16.0}, fmt::format("{:g}", v),
                {.size = 11.0, .anchor = Anchor::middle, .colour = kInk});
  }
  canvas.text({0.5 * (time.from + time.to), y + 32.0}, diagram.time_label,
              {.size = 12.0, .anchor = Anchor::middle, .colour = kInk});
}

}  // namespace kinemark::report
