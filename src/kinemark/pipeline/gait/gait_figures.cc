// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/text.h"

namespace kinemark::pipeline {
namespace {

using data::Side;
using report::Figure;
using report::FigurePanel;

constexpr double kWidth = 840.0, kHeight = 118.0;
constexpr std::int64_t kColumns = 3;
constexpr double kTwoSided = 1.959964;   // 95 % of a normal error
constexpr std::int64_t kMostDrawn = 40;  // cycles of a side
constexpr double kThinnest = 2.5;        // pixels that an error has to reach to each side to be seen
constexpr double kFinest = 0.01;         // of an own error, in the panel's unit
constexpr double kSlight = 0.0005;       // share not measured that is not worth a word
const std::string kNormGrey = "#9a9a9a";
constexpr double kNormOpacity = 0.35, kBandOpacity = 0.18, kThinShare = 0.45;

Eigen::VectorXd percent_of(Eigen::Index points) { return Eigen::VectorXd::LinSpaced(points, 0.0, 100.0); }

/// What is drawn at least once, and so explained.
struct Shown {
  bool between = false, own = false, norm = false, off = false;
  std::array<bool, 2> sides{};
};

void draw_norm(FigurePanel& panel, const SheetCurve& curve, Shown& shown) {
  if (curve.norm.rows() == 0) return;
  panel.bands.push_back({.colour = kNormGrey,
                         .x = percent_of(curve.norm.rows()),
                         .low = curve.norm.col(0),
                         .high = curve.norm.col(1),
                         .opacity = kNormOpacity});
  shown.norm = true;
}

// Lowest and highest of all that is drawn of a panel but its own error.
double reach_of(const SheetPanel& panel) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto include = [&](const Eigen::Ref<const Eigen::MatrixXd>& values) {
    for (const double v : values.reshaped())
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  };
  for (const auto& side : panel.sides) {
    if (!side) continue;
    include(side->values);
    include(side->mean - side->between);
    include(side->mean + side->between);
    if (side->norm.rows() > 0) include(side->norm.leftCols(2));
  }
  return high - low;
}

// The largest half-width of what holds 95 % of the measurement's own error; 0: not known.
double widest_own(const SheetPanel& panel) {
  double widest = 0.0;
  for (const auto& side : panel.sides)
    for (Eigen::Index p = 0; side && p < side->own.size(); ++p)
      if (std::isfinite(side->own[p])) widest = std::max(widest, kTwoSided * side->own[p]);
  return widest;
}

std::string own_in_words(double widest, const std::string& unit) {
  if (widest < kFinest) return fmt::format("own error below {:g} {}", kFinest, unit);
  return fmt::format("own error \u00b1 {:.2g} {} at most", widest, unit);
}

// Whether that error can be told from the line of the mean.
bool shows_own(const SheetPanel& panel) {
  const double widest = widest_own(panel);
  return widest > 0.0 && widest * kHeight >= kThinnest * reach_of(panel);
}

void draw_curve(FigurePanel& panel, const SheetCurve& curve, Side side, bool own, Shown& shown) {
  const std::string colour(side_colour(side));
  const Eigen::VectorXd x = percent_of(curve.mean.size());
  const bool right = side == Side::right;
  if (curve.between.array().isFinite().any()) {
    panel.bands.push_back({.colour = colour,
                           .x = x,
                           .low = curve.mean - curve.between,
                           .high = curve.mean + curve.between,
                           .opacity = kBandOpacity});
    shown.between = true;
  }
  if (curve.values.cols() > 1)
    for (Eigen::Index c = 0; c < std::min<Eigen::Index>(curve.values.cols(), kMostDrawn); ++c)
      panel.lines.push_back(
          {.colour = report::tint(colour, kThinShare), .x = x, .y = curve.values.col(c), .width = 0.6});
  if (own && curve.own.array().isFinite().any()) {
    for (const double sign : {-kTwoSided, kTwoSided})
      panel.lines.push_back(
          {.colour = colour, .x = x, .y = curve.mean + sign * curve.own, .width = 0.9, .dotted = true});
    shown.own = true;
  }
  panel.lines.push_back({.colour = colour, .x = x, .y = curve.mean, .width = 2.0, .dashed = right});
  shown.sides[data::index_of(side)] = true;
}

std::string not_measured(const SheetPanel& panel) {
  std::string out;
  for (const auto side : data::kBothSides) {
    const auto& curve = panel.sides[data::index_of(side)];
    if (!curve || curve->not_measured < kSlight) continue;
    out += fmt::format("{}{} ", out.empty() ? "" : ", ", side == Side::left ? "left" : "right");
    const auto seen = curve->values.array().isFinite().colwise().any().count();
    if (panel.what.part == SheetPart::kinetics && seen < curve->values.cols())
      out += fmt::format("{} of {}", seen, counted(curve->values.cols(), "cycle"));
    else
      out += fmt::format("{:.2g} % not measured", 100.0 * curve->not_measured);
  }
  return out;
}

FigurePanel drawn(const SheetPanel& from, const GaitSheet& sheet, Shown& shown) {
  FigurePanel out{.title = fmt::format("{} ({})", from.what.title, from.unit),
                  .note = not_measured(from),
                  .y_up = from.what.up,
                  .y_down = from.what.down,
                  .tight = true,
                  .zero = true};
  const bool own = shows_own(from);
  if (const double widest = widest_own(from); widest > 0.0 && !own)
    out.note += (out.note.empty() ? "" : ", ") + own_in_words(widest, from.unit);
  if (from.mirrored) out.note += (out.note.empty() ? "" : ", ") + std::string("one sign for both sides");
  for (const auto& side : from.sides)
    if (side) draw_norm(out, *side, shown);
  // One norm of both sides is drawn once.
  if (out.bands.size() == 2 && out.bands[0].low.size() == out.bands[1].low.size() &&
      (out.bands[0].low.array() == out.bands[1].low.array()).all() &&
      (out.bands[0].high.array() == out.bands[1].high.array()).all())
    out.bands.pop_back();
  for (const auto side : data::kBothSides) {
    const auto& curve = from.sides[data::index_of(side)];
    if (!curve || curve->empty()) continue;
    draw_curve(out, *curve, side, own, shown);
    const auto& foot = sheet.feet[data::index_of(side)];
    if (!std::isfinite(foot.off_share)) continue;
    out.marks.push_back({.x = 100.0 * foot.off_share,
                         .colour = std::string(side_colour(side)),
                         .dashed = side == Side::right});
    shown.off = true;
  }
  return out;
}

// Panels with a place stand in it, those without follow; rows without a panel are not there.
std::vector<FigurePanel> gridded(const std::vector<const SheetPanel*>& panels, const GaitSheet& sheet,
                                 Shown& shown) {
  std::vector<FigurePanel> out;
  std::int64_t row = -1;
  const auto fill = [&] {
    while (out.size() % static_cast<std::size_t>(kColumns) != 0) out.push_back({.blank = true});
  };
  for (const auto* panel : panels) {
    if (panel->what.row != row) fill();
    row = panel->what.row;
    if (row >= 0)
      while (static_cast<std::int64_t>(out.size()) % kColumns < panel->what.column)
        out.push_back({.blank = true});
    out.push_back(drawn(*panel, sheet, shown));
  }
  // The lowest of each column names the axis.
  for (std::size_t column = 0; column < static_cast<std::size_t>(kColumns); ++column) {
    FigurePanel* lowest = nullptr;
    for (std::size_t i = column; i < out.size(); i += static_cast<std::size_t>(kColumns))
      if (!out[i].blank) lowest = &out[i];
    if (lowest != nullptr) lowest->x_label = "gait cycle (%)";
  }
  return out;
}

std::vector<report::FigureKey> keys_of(const GaitSheet& sheet, const Shown& shown) {
  std::vector<report::FigureKey> out;
  const std::string one(side_colour(shown.sides[data::index_of(Side::left)] ? Side::left : Side::right));
  for (const auto side : data::kBothSides)
    if (shown.sides[data::index_of(side)])
      out.push_back({.name = fmt::format("{}, mean of {}", data::to_string(side),
                                         counted(sheet.feet[data::index_of(side)].cycles, "cycle")),
                     .colour = std::string(side_colour(side)),
                     .dashed = side == Side::right});
  if (shown.between)
    out.push_back(
        {.name = "\u00b1 1 SD between cycles", .colour = one, .band = true, .opacity = 2.0 * kBandOpacity});
  if (shown.own)
    out.push_back({.name = "95 % of the measurement\u2019s own error",
                   .colour = "#404040",
                   .dotted = true,
                   .width = 1.2});
  if (shown.norm) out.push_back({.name = "norm", .colour = kNormGrey, .band = true, .opacity = kNormOpacity});
  if (shown.off) out.push_back({.name = "toe-off", .colour = one, .width = 1.0});
  return out;
}

// Of a model's outputs in the recording, such as "LHipMoment x".
bool is_of_file(const SheetPanel* panel) {
  return std::ranges::any_of(
      panel->sides, [](const auto& side) { return side && side->id.find(' ') != std::string::npos; });
}

struct PartWords {
  SheetPart part;
  const char* name;
  const char* title;
};
constexpr std::array kParts = {
    PartWords{SheetPart::kinematics, "gait_kinematics", "joint angles over the gait cycle"},
    PartWords{SheetPart::others, "gait_other_angles", "other angles over the gait cycle"},
    PartWords{SheetPart::kinetics, "gait_kinetics", "moments, powers and ground reaction"}};

}  // namespace

std::string_view side_colour(Side side) { return report::kFigureColours[side == Side::left ? 1 : 0]; }

std::string sentence_of(const SheetSide& foot, Side side) {
  std::string out = fmt::format("{}: {}", data::to_string(side), counted(foot.cycles, "cycle"));
  if (!std::isfinite(foot.off_share)) return out;
  out += fmt::format(", toe-off at {:.1f}", 100.0 * foot.off_share);
  if (std::isfinite(foot.off_sd_share)) out += fmt::format(" \u00b1 {:.1f}", 100.0 * foot.off_sd_share);
  return out + fmt::format(" % ({:.2f} s)", foot.off_s);
}

std::string norms_in_words(const GaitSheet& sheet) {
  std::vector<std::string> out;
  for (const auto& panel : sheet.panels)
    for (const auto& side : panel.sides) {
      if (!side || side->norm.rows() == 0) continue;
      auto words = fmt::format("{} ({})", side->norm_source, side->norm_meaning);
      if (std::ranges::find(out, words) == out.end()) out.push_back(std::move(words));
    }
  return join(out, "; ");
}

std::vector<GaitFigure> gait_figures(const GaitSheet& sheet) {
  std::vector<GaitFigure> out;
  for (const auto& [part, name, title] : kParts) {
    std::vector<const SheetPanel*> panels;
    for (const auto& panel : sheet.panels)
      if (panel.what.part == part) panels.push_back(&panel);
    if (panels.empty()) continue;
    Shown shown;
    Figure figure{.title = fmt::format("{}: {}", sheet.trial, title),
                  .panels = gridded(panels, sheet, shown),
                  .width = kWidth,
                  .columns = kColumns,
                  .panel_height = kHeight};
    figure.keys = keys_of(sheet, shown);
    std::string note;
    for (const auto side : data::kBothSides)
      if (shown.sides[data::index_of(side)])
        note += (note.empty() ? "" : "; ") + sentence_of(sheet.feet[data::index_of(side)], side);
    figure.notes.push_back(note + ".");
    if (shown.norm) figure.notes.push_back("Norm: " + norms_in_words(sheet) + ".");
    if (part == SheetPart::kinetics && std::ranges::any_of(panels, is_of_file))
      figure.notes.push_back(
          "Moments and powers of the recording are in its file's units, which do not tell whether they are "
          "per "
          "kilogram of body mass; Plug-in Gait's are.");
    if (part == SheetPart::kinetics)
      figure.notes.push_back(
          "Ground reaction: of the strikes that a plate saw whole, up is positive. Powers: generated is "
          "positive.");
    out.push_back({.name = name, .figure = std::move(figure)});
  }
  return out;
}

}  // namespace kinemark::pipeline
