// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/angle_angle.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"

namespace kinemark::pipeline {
namespace {

using data::Side;
using report::FigurePanel;
using report::SymbolShape;

constexpr double kPairWidth = 720.0;
constexpr int kCorners = 24;                               // of an ellipse
constexpr std::array kArrowsAt = {0.12, 0.45, 0.72, 0.9};  // shares of the cycle
constexpr double kThin = 0.55, kAreaShare = 0.22;          // of a colour
constexpr Eigen::Index kMostCyclesDrawn = 40;
constexpr std::array kUsual = {std::pair{"hip_flexion", "knee_flexion"},
                               std::pair{"knee_flexion", "ankle_dorsiflexion"}};

// One of a sheet, or a sentence.
const SheetPanel* panel_of(const GaitSheet& sheet, const std::string& name, const std::string& pair,
                           std::vector<std::string>& remarks) {
  const auto* found = find_panel(sheet, name);
  if (found != nullptr) return found;
  std::vector<std::string> names;
  for (const auto& panel : sheet.panels) names.push_back(panel.what.key);
  const auto nearest = nearest_names(name, names);
  remarks.push_back(fmt::format("--angle-angle {}: there is no curve '{}'{}", pair, name,
                                nearest.empty() ? fmt::format("; there are {}", join_some(names, 12))
                                                : fmt::format(" (nearest: {})", join(nearest))));
  return nullptr;
}

// Around a point, one standard deviation in each direction.
void add_ellipse(const CyclogramPoint& point, std::vector<Eigen::Vector2d>& out) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(point.covariance);
  const Eigen::Vector2d lengths = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    out.push_back(point.mean + solver.eigenvectors() * Eigen::Vector2d(lengths[0] * std::cos(angle),
                                                                       lengths[1] * std::sin(angle)));
  }
}

void add_spread(FigurePanel& panel, const std::vector<CyclogramPoint>& points, const std::string& colour) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i].cycles < 2 || points[i + 1].cycles < 2) continue;
    std::vector<Eigen::Vector2d> corners;
    add_ellipse(points[i], corners);
    add_ellipse(points[i + 1], corners);
    const auto hull = convex_hull(std::move(corners));
    report::FigureArea area{.colour = report::tint(colour, kAreaShare)};
    area.x.resize(std::ssize(hull));
    area.y.resize(std::ssize(hull));
    for (Eigen::Index k = 0; k < area.x.size(); ++k)
      area.x[k] = hull[static_cast<std::size_t>(k)].x(), area.y[k] = hull[static_cast<std::size_t>(k)].y();
    if (panel.areas.empty()) area.name = "1 SD between cycles";
    panel.areas.push_back(std::move(area));
  }
}

// Between two points of the cycle; NaN where one is not there.
Eigen::Vector2d along(const std::vector<CyclogramPoint>& points, double share) {
  const double at = share * static_cast<double>(points.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), points.size() - 2);
  const double later = at - static_cast<double>(below);
  return (1.0 - later) * points[below].mean + later * points[below + 1].mean;
}

void add_symbols(FigurePanel& panel, const std::vector<CyclogramPoint>& points, const SheetSide& foot,
                 const std::string& colour) {
  for (const double share : kArrowsAt) {
    const double step = 0.5 / static_cast<double>(points.size() - 1);
    panel.symbols.push_back({.shape = SymbolShape::arrow,
                             .colour = colour,
                             .at = along(points, share),
                             .towards = along(points, share + step) - along(points, share - step)});
  }
  panel.symbols.push_back({.name = "strike", .colour = colour, .at = points.front().mean});
  if (std::isfinite(foot.off_share))
    panel.symbols.push_back({.shape = SymbolShape::ring,
                             .name = "toe-off",
                             .colour = colour,
                             .at = along(points, std::clamp(foot.off_share, 0.0, 1.0))});
}

std::string axis_label(const SheetPanel& panel) {
  const std::string up = panel.what.up.empty() ? "" : fmt::format(", {} +", panel.what.up);
  return fmt::format("{} ({}{})", panel.what.title, panel.unit, up);
}

FigurePanel panel_of_side(const GaitSheet& sheet, const AnglePair& pair, Side side) {
  const auto i = data::index_of(side);
  FigurePanel out{.title = std::string(data::to_string(side)),
                  .note = sentence_of(sheet.feet[i], side).substr(data::to_string(side).size() + 2),
                  .x_label = axis_label(*pair.x),
                  .y_label = axis_label(*pair.y),
                  .equal = pair.x->unit == pair.y->unit};
  const auto &x = pair.x->sides[i], &y = pair.y->sides[i];
  if (!x || !y) return {.blank = true};
  const std::string colour(side_colour(side));
  const auto points = cyclogram(*x, *y);
  if (std::ranges::none_of(points, [](const CyclogramPoint& p) { return p.cycles > 0; }))
    return {.blank = true};
  add_spread(out, points, colour);
  if (x->values.cols() > 1)
    for (Eigen::Index c = 0; c < std::min(x->values.cols(), kMostCyclesDrawn); ++c)
      out.lines.push_back({.colour = report::tint(colour, kThin),
                           .x = x->values.col(c),
                           .y = y->values.col(c),
                           .width = 0.7});
  report::FigureLine mean{.name = "mean", .colour = colour, .width = 2.0};
  mean.x.resize(std::ssize(points));
  mean.y.resize(std::ssize(points));
  for (Eigen::Index p = 0; p < mean.x.size(); ++p)
    mean.x[p] = points[static_cast<std::size_t>(p)].mean.x(),
    mean.y[p] = points[static_cast<std::size_t>(p)].mean.y();
  out.lines.push_back(std::move(mean));
  add_symbols(out, points, sheet.feet[i], colour);
  return out;
}

// Both panels reach as far, so that sides compare.
void share_room(FigurePanel& a, FigurePanel& b) {
  const auto reach = [](const FigurePanel& from, FigurePanel& to) {
    for (const auto& line : from.lines)
      for (Eigen::Index i = 0; i < line.x.size(); ++i) to.room.emplace_back(line.x[i], line.y[i]);
    for (const auto& area : from.areas)
      for (Eigen::Index i = 0; i < area.x.size(); ++i) to.room.emplace_back(area.x[i], area.y[i]);
  };
  reach(a, b);
  reach(b, a);
}

std::string file_part(const std::string& key) {
  std::string out;
  for (const char c : key) out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return out;
}

double cross(const Eigen::Vector2d& o, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

}  // namespace

std::vector<AnglePair> angle_pairs(const GaitSheet& sheet, std::span<const std::string> asked,
                                   std::vector<std::string>& remarks) {
  std::vector<AnglePair> out;
  if (asked.empty()) {
    for (const auto& [x, y] : kUsual)
      if (const AnglePair pair{find_panel(sheet, x), find_panel(sheet, y)};
          pair.x != nullptr && pair.y != nullptr)
        out.push_back(pair);
    return out;
  }
  for (const auto& text : asked) {
    const auto colon = text.find(':');
    const auto* x = panel_of(sheet, text.substr(0, colon), text, remarks);
    const auto* y =
        colon == std::string::npos ? nullptr : panel_of(sheet, text.substr(colon + 1), text, remarks);
    if (x != nullptr && y != nullptr) out.push_back({x, y});
  }
  return out;
}

std::vector<CyclogramPoint> cyclogram(const SheetCurve& x, const SheetCurve& y) {
  check(x.values.rows() == y.values.rows() && x.values.cols() == y.values.cols(),
        "curves against each other are of the same cycles");
  std::vector<CyclogramPoint> out;
  for (Eigen::Index p = 0; p < x.values.rows(); ++p) {
    std::vector<Eigen::Vector2d> seen;
    for (Eigen::Index c = 0; c < x.values.cols(); ++c)
      if (const Eigen::Vector2d v(x.values(p, c), y.values(p, c)); v.allFinite()) seen.push_back(v);
    CyclogramPoint point{.mean = Eigen::Vector2d::Constant(kNaN),
                         .covariance = Eigen::Matrix2d::Constant(kNaN),
                         .cycles = static_cast<int>(seen.size())};
    if (!seen.empty()) {
      point.mean.setZero();
      for (const auto& v : seen) point.mean += v / static_cast<double>(seen.size());
    }
    if (seen.size() > 1) {
      point.covariance.setZero();
      for (const auto& v : seen)
        point.covariance +=
            (v - point.mean) * (v - point.mean).transpose() / static_cast<double>(seen.size() - 1);
    }
    out.push_back(point);
  }
  return out;
}

std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  if (points.size() < 3) return points;
  std::ranges::sort(points, [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Eigen::Vector2d> hull;
  // Lower side from left to right, then upper side back (Andrew's monotone chain).
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = hull.size();
    for (const auto& point : points) {
      while (hull.size() >= begin + 2 && cross(hull[hull.size() - 2], hull.back(), point) <= 0.0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

std::vector<GaitFigure> angle_angle_figures(const GaitSheet& sheet, std::span<const AnglePair> pairs) {
  std::vector<GaitFigure> out;
  for (const auto& pair : pairs) {
    std::vector<FigurePanel> panels;
    for (const auto side : data::kBothSides)
      if (auto panel = panel_of_side(sheet, pair, side); !panel.blank) panels.push_back(std::move(panel));
    if (panels.empty()) continue;
    if (panels.size() == 2)
      share_room(panels[0], panels[1]);
    else
      panels.push_back({.blank = true});
    report::Figure figure{
        .title = fmt::format("{}: {} against {}", sheet.trial, pair.y->what.title, pair.x->what.title),
        .panels = std::move(panels),
        .width = kPairWidth,
        .columns = 2};
    figure.notes.push_back(
        "Arrows: direction of time. Area: what ellipses of one standard deviation between cycles (covariance "
        "of "
        "both, 39 % of normal cycles within) cover along the mean.");
    out.push_back(
        {.name = fmt::format("gait_{}_{}", file_part(pair.x->what.key), file_part(pair.y->what.key)),
         .figure = std::move(figure)});
  }
  return out;
}

}  // namespace kinemark::pipeline
