// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_sheet.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/stages/analysis/gait/cycle_curves.h"

namespace kinemark::pipeline {
namespace {

using data::Side;

constexpr double kPlainKneeFlexion_deg = 30.0;  // a knee does not bend so far the other way
constexpr std::array<std::string_view, 6> kMiddle = {"pelvis", "lumbar", "trunk", "torso", "thorax", "neck"};
constexpr std::array<std::string_view, 4> kSagittal = {"tilt", "flexion", "extension", "pitch"};
constexpr std::size_t kMostNames = 6;  // in a sentence

std::optional<Side> side_named(const std::string& context) {
  for (const auto side : data::kBothSides)
    if (context == data::to_string(side)) return side;
  return std::nullopt;
}

bool is_shown(data::Quantity quantity) {
  switch (quantity) {
    case data::Quantity::angle:
    case data::Quantity::force:
    case data::Quantity::moment:
    case data::Quantity::power:
    case data::Quantity::moment_per_mass:
    case data::Quantity::power_per_mass:
      return true;
    default:
      return false;
  }
}

SheetCurve curve_of(const data::CycleCurves& in, double per_si) {
  const auto points = in.points, cycles = in.count();
  const auto matrix = [&](const std::vector<double>& values) {
    return Eigen::MatrixXd(per_si * Eigen::Map<const Eigen::MatrixXd>(values.data(), points, cycles));
  };
  SheetCurve out{.id = in.id, .values = matrix(in.values)};
  if (!in.sd.empty()) out.sd = matrix(in.sd);
  const auto mean = analysis::mean_of_cycles(in);
  out.mean.resize(points);
  out.between.resize(points);
  out.count.resize(points);
  out.own = Eigen::VectorXd::Constant(points, kNaN);
  std::int64_t there = 0;
  for (std::int64_t p = 0; p < points; ++p) {
    out.mean[p] = per_si * mean.mean[at(p)];
    out.between[p] = per_si * mean.sd[at(p)];
    out.count[p] = static_cast<int>(mean.cycles[at(p)]);
    there += mean.cycles[at(p)];
    double squares = 0.0;
    std::int64_t known = 0;
    for (std::int64_t c = 0; c < out.sd.cols(); ++c)
      if (std::isfinite(out.sd(p, c)) && std::isfinite(out.values(p, c)))
        squares += out.sd(p, c) * out.sd(p, c), ++known;
    if (known > 0) out.own[p] = std::sqrt(squares / static_cast<double>(known));
  }
  const auto all = points * cycles;
  out.not_measured = all > 0 ? 1.0 - static_cast<double>(there) / static_cast<double>(all) : 1.0;
  return out;
}

// The sign of a knee's angle shows in its swing, whatever the model calls it.
void tell_knee_direction(SheetPanel& panel) {
  if (panel.what.key != "knee_flexion" || !panel.what.up.empty()) return;
  double lowest = 0.0, highest = 0.0;
  for (const auto& side : panel.sides)
    for (std::int64_t p = 0; side && p < side->mean.size(); ++p)
      if (std::isfinite(side->mean[p]))
        lowest = std::min(lowest, side->mean[p]), highest = std::max(highest, side->mean[p]);
  if (highest > kPlainKneeFlexion_deg && lowest > -kPlainKneeFlexion_deg)
    panel.what.up = "flexion", panel.what.down = "extension", panel.what.same_sign = true;
  else if (lowest < -kPlainKneeFlexion_deg && highest < kPlainKneeFlexion_deg)
    panel.what.up = "extension", panel.what.down = "flexion";
}

void add_curve(GaitSheet& sheet, const SheetInput& input) {
  const auto side = side_named(input.curves.context);
  if (!side || !is_shown(input.curves.quantity)) return;
  auto what = gait_quantity(input.curves.id, input.curves.quantity);
  if (what.side && *what.side != *side) return;
  if (what.part == SheetPart::kinetics && what.row < 0) return;  // not of the legs
  const auto unit = data::shown_unit(input.curves.quantity);
  const std::string shown = input.unit.empty() ? std::string(unit.name) : input.unit;
  auto curve = curve_of(input.curves, input.unit.empty() ? unit.per_si : 1.0);
  const auto base = name_without_side(input.curves.id);
  for (auto& panel : sheet.panels) {
    auto& place = panel.sides[data::index_of(*side)];
    const auto& other = panel.sides[data::index_of(data::opposite(*side))];
    if (panel.what.part != what.part || panel.unit != shown || place || !other) continue;
    if (name_without_side(other->id) != base) continue;
    place = std::move(curve);
    return;
  }
  SheetPanel panel{.what = std::move(what), .unit = shown};
  panel.sides[data::index_of(*side)] = std::move(curve);
  sheet.panels.push_back(std::move(panel));
}

SheetSide side_of(const analysis::Gait& gait, Side side) {
  SheetSide out;
  std::vector<double> shares;
  double time = 0.0;
  for (const auto& cycle : gait.cycles) {
    if (cycle.side != side) continue;
    ++out.cycles;
    if (!std::isfinite(cycle.off_s)) continue;
    shares.push_back((cycle.off_s - cycle.start_s) / (cycle.end_s - cycle.start_s));
    time += cycle.off_s - cycle.start_s;
  }
  if (shares.empty()) return out;
  const auto n = static_cast<double>(shares.size());
  const Eigen::Map<const Eigen::VectorXd> all(shares.data(), std::ssize(shares));
  out.off_share = all.mean();
  out.off_s = time / n;
  if (shares.size() > 1)
    out.off_sd_share = std::sqrt((all.array() - out.off_share).square().sum() / (n - 1.0));
  return out;
}

// Whether a curve counts one way for both sides, so that left and right mirror each other: a coordinate of
// the pelvis or trunk in the frontal or the transverse plane.
bool is_mirrored(const SheetCurve& curve) {
  const auto is_in_name = [&](std::string_view word) { return curve.id.find(word) != std::string::npos; };
  return !gait_quantity(curve.id, data::Quantity::angle).side && std::ranges::any_of(kMiddle, is_in_name) &&
         std::ranges::none_of(kSagittal, is_in_name);
}

// Whether a norm's unit is another; one that is not told is taken for the same.
bool is_in(const NormCurve& norm, const std::string& unit) { return norm.unit.empty() || norm.unit == unit; }

void add_norm(SheetPanel& panel, const GaitNorms& norms, std::set<const NormCurve*>& used,
              std::set<std::string>& odd) {
  for (const auto side : data::kBothSides) {
    auto& curve = panel.sides[data::index_of(side)];
    if (!curve) continue;
    const auto* norm = find_norm(norms, curve->id, side);
    if (norm == nullptr && panel.what.same_sign) norm = find_norm(norms, panel.what.title, side);
    if (norm == nullptr) continue;
    used.insert(norm);
    if (is_mirrored(*curve) && !norm->side) {
      odd.insert(
          fmt::format("the norm of {} tells no side, but the curve counts one way for both: it is not drawn; "
                      "a column context says whose it is",
                      norm->name));
      continue;
    }
    if (!is_in(*norm, panel.unit)) {
      odd.insert(fmt::format("the norm of {} is in '{}', the curve in '{}': it is not drawn", norm->name,
                             norm->unit, panel.unit));
      continue;
    }
    const auto points = curve->mean.size();
    curve->norm.resize(points, 3);
    for (Eigen::Index p = 0; p < points; ++p) {
      const auto band = norm_at(*norm, 100.0 * static_cast<double>(p) / static_cast<double>(points - 1));
      curve->norm.row(p) << band.low, band.high, band.mean;
    }
    curve->norm_source = norm->source;
    curve->norm_meaning = norm->meaning;
  }
}

void tell_norms(GaitSheet& sheet, const GaitNorms& norms, const std::set<const NormCurve*>& used) {
  std::vector<std::string> idle, drawn;
  for (const auto& norm : norms.curves)
    if (!used.contains(&norm)) idle.push_back(norm.name);
  if (idle.empty()) return;
  for (const auto& panel : sheet.panels)
    for (const auto& side : panel.sides)
      if (side && !side->empty()) drawn.push_back(side->id);
  sheet.remarks.push_back(fmt::format(
      "the norm's {} {} no curve here; {}", join_some(idle, kMostNames), idle.size() == 1 ? "fits" : "fit",
      drawn.empty() ? "none is drawn" : "drawn are " + join_some(drawn, kMostNames)));
}

void tell_cycles(GaitSheet& sheet) {
  for (const auto side : data::kBothSides) {
    const auto& foot = sheet.feet[data::index_of(side)];
    const auto name = data::to_string(side);
    if (foot.cycles == 0)
      sheet.remarks.push_back(fmt::format("{}: there is no cycle from strike to strike", name));
    else if (foot.cycles == 1)
      sheet.remarks.push_back(fmt::format("{}: one cycle alone has no deviation between cycles", name));
    std::vector<std::string> empty;
    for (const auto& panel : sheet.panels)
      if (const auto& curve = panel.sides[data::index_of(side)]; curve && curve->empty())
        empty.push_back(curve->id);
    if (!empty.empty())
      sheet.remarks.push_back(fmt::format("{}: {} without a value in {}: {}", name,
                                          counted(std::ssize(empty), "curve"), counted(foot.cycles, "cycle"),
                                          join_some(empty, kMostNames)));
  }
}

}  // namespace

GaitSheet make_gait_sheet(const std::string& trial, const std::vector<SheetInput>& curves,
                          const analysis::Gait& gait, const GaitNorms& norms) {
  GaitSheet out{.trial = trial,
                .events = gait.events,
                .measures = gait.measures,
                .norms = norms.measures,
                .treadmill = gait.treadmill};
  for (const auto side : data::kBothSides) out.feet[data::index_of(side)] = side_of(gait, side);
  for (const auto& curve : curves) add_curve(out, curve);
  for (auto& panel : out.panels)
    panel.mirrored = panel.what.part != SheetPart::kinetics &&
                     std::ranges::any_of(panel.sides, [](const auto& c) { return c && is_mirrored(*c); });
  std::ranges::stable_sort(out.panels, {}, [](const SheetPanel& panel) {
    constexpr std::int64_t kLast = 1'000;
    return std::tuple(panel.what.part, panel.what.row < 0 ? kLast : panel.what.row, panel.what.column);
  });
  std::set<const NormCurve*> used;
  std::set<std::string> odd;
  for (auto& panel : out.panels) {
    tell_knee_direction(panel);
    add_norm(panel, norms, used, odd);
  }
  tell_cycles(out);
  for (const auto& sentence : odd) out.remarks.push_back(sentence);
  tell_norms(out, norms, used);
  std::erase_if(out.panels, [](const SheetPanel& panel) {
    return std::ranges::none_of(panel.sides, [](const auto& side) { return side && !side->empty(); });
  });
  return out;
}

const SheetPanel* find_panel(const GaitSheet& sheet, const std::string& name) {
  const auto small = [](const std::string& text) {
    std::string out;
    for (const char c : text) out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
  };
  const auto is = [&](const SheetPanel& panel) {
    if (panel.what.key == name || small(panel.what.title) == small(name)) return true;
    return std::ranges::any_of(panel.sides, [&](const auto& side) {
      return side && (side->id == name || name_without_side(side->id) == name);
    });
  };
  const auto found = std::ranges::find_if(sheet.panels, is);
  return found == sheet.panels.end() ? nullptr : &*found;
}

}  // namespace kinemark::pipeline
