// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/internal/legend.h"

#include <algorithm>
#include <utility>

namespace kinemark::report::internal {
namespace {

constexpr double kLine = 16.0, kSample = 22.0, kGap = 6.0, kBetween = 14.0;
constexpr double kLetterShare = 0.55;  // a letter's width, of its size
constexpr double kSize = 12.0, kSymbol = 3.6, kArrow = 9.0;
const std::string kLegendInk = "#1a1a1a";

}  // namespace

double text_width(std::string_view text, double size) {
  const auto letters =
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; });
  return kLetterShare * size * static_cast<double>(letters);
}

std::vector<std::string> broken_text(std::string_view text, double size, double width) {
  std::vector<std::string> out;
  std::string line;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = std::min(text.find(' ', begin), text.size());
    const std::string word(text.substr(begin, end - begin));
    begin = end + 1;
    if (!line.empty() && text_width(line + " " + word, size) > width) out.push_back(std::exchange(line, {}));
    line += (line.empty() ? "" : " ") + word;
  }
  if (!line.empty()) out.push_back(std::move(line));
  return out;
}

void draw_symbol(Canvas& canvas, SymbolShape shape, const Eigen::Vector2d& at,
                 const Eigen::Vector2d& direction, const std::string& colour) {
  if (shape == SymbolShape::arrow) {
    const Eigen::Vector2d along = direction.normalized(), across(-along.y(), along.x());
    canvas.area(std::vector<Eigen::Vector2d>{at, at - kArrow * along + 0.5 * kArrow * across,
                                             at - kArrow * along - 0.5 * kArrow * across},
                colour, 1.0);
    return;
  }
  canvas.dot(at, kSymbol + 1.0, "#ffffff");
  canvas.dot(at, kSymbol, colour);
  if (shape == SymbolShape::ring) canvas.dot(at, kSymbol - 1.5, "#ffffff");
}

Legend::Legend(const FigurePanel& panel, double width) {
  for (const auto& area : panel.areas)
    if (!area.name.empty())
      entries_.push_back({.name = area.name, .look = Look::area, .stroke = {.colour = area.colour}});
  for (const auto& band : panel.bands)
    if (!band.name.empty())
      entries_.push_back({.name = band.name,
                          .look = Look::area,
                          .stroke = {.colour = band.colour},
                          .opacity = band.opacity});
  for (const auto& line : panel.lines)
    if (!line.name.empty())
      entries_.push_back(
          {.name = line.name,
           .stroke = {.colour = line.colour, .width = 2.0, .dashed = line.dashed, .dotted = line.dotted}});
  for (const auto& symbol : panel.symbols)
    if (!symbol.name.empty())
      entries_.push_back({.name = symbol.name,
                          .look = Look::symbol,
                          .stroke = {.colour = symbol.colour},
                          .shape = symbol.shape});
  lay_out(width);
}

Legend::Legend(const std::vector<FigureKey>& keys, double width) {
  for (const auto& key : keys)
    entries_.push_back(
        {.name = key.name,
         .look = key.band ? Look::area : Look::line,
         .stroke = {.colour = key.colour, .width = key.width, .dashed = key.dashed, .dotted = key.dotted},
         .opacity = key.band ? key.opacity : 1.0});
  lay_out(width);
}

void Legend::lay_out(double width) {
  Eigen::Vector2d at(0.0, 0.0);
  for (auto& entry : entries_) {
    const double wide = kSample + kGap + text_width(entry.name, kSize);
    if (at.x() + wide > width && at.x() > 0.0) at = {0.0, at.y() + kLine};
    entry.at = at;
    at.x() += wide + kBetween;
  }
  height_ = entries_.empty() ? 0.0 : at.y() + kLine;
}

void Legend::draw(Canvas& canvas, const Eigen::Vector2d& corner) const {
  for (const auto& entry : entries_) {
    const double x = corner.x() + entry.at.x(), y = corner.y() + entry.at.y();
    if (entry.look == Look::area)
      canvas.area(
          std::vector<Eigen::Vector2d>{
              {x, y - 5.0}, {x + kSample, y - 5.0}, {x + kSample, y + 5.0}, {x, y + 5.0}},
          entry.stroke.colour, entry.opacity);
    else if (entry.look == Look::line)
      canvas.line(std::vector<Eigen::Vector2d>{{x, y}, {x + kSample, y}}, entry.stroke);
    else
      draw_symbol(canvas, entry.shape, {x + 0.5 * kSample, y}, Eigen::Vector2d::UnitX(), entry.stroke.colour);
    canvas.text({x + kSample + kGap, y + 4.0}, entry.name, {.size = kSize, .colour = kLegendInk});
  }
}

}  // namespace kinemark::report::internal
