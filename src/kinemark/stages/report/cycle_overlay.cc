// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/cycle_overlay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/report/internal/curve_block.h"
#include "kinemark/stages/report/internal/json_parts.h"

namespace kinemark::report {
namespace {

using Json = nlohmann::ordered_json;

std::vector<float> in_unit(std::span<const double> values, double unit) {
  std::vector<float> out;
  for (const double v : values) out.push_back(static_cast<float>(unit * v));
  return out;
}

bool is_whole(const data::CycleCurves& curves, std::int64_t cycle) {
  for (std::int64_t p = 0; p < curves.points; ++p)
    if (!std::isfinite(curves(cycle, p))) return false;
  return true;
}

// Every cycle, or so many of them at equal distances, the first and the last among them.
std::vector<std::int64_t> drawn_of(std::int64_t count) {
  std::vector<std::int64_t> out;
  const std::int64_t drawn = std::min(count, kMostCyclesDrawn);
  for (std::int64_t i = 0; i < drawn; ++i)
    out.push_back(drawn == count ? i : (i * (count - 1) + (drawn - 1) / 2) / (drawn - 1));
  return out;
}

Json overlay_json(const CycleOverlay& overlay) {
  const auto& curves = overlay.curves;
  check(std::ssize(overlay.mean) == curves.points && std::ssize(overlay.sd) == curves.points &&
            std::ssize(overlay.cycles) == curves.points,
        "an overlay needs a mean, a deviation and a count for each point");
  const bool turns = curves.quantity == data::Quantity::angle;
  const double unit = turns ? kDegPerRad : 1.0,
               usual = turns ? internal::kUsualStep_deg : internal::kUsualStep_m;
  std::int64_t whole = 0;
  for (std::int64_t c = 0; c < curves.count(); ++c) whole += is_whole(curves, c) ? 1 : 0;
  std::vector<double> each;
  const auto drawn = drawn_of(curves.count());
  for (const auto c : drawn)
    for (std::int64_t p = 0; p < curves.points; ++p) each.push_back(curves(c, p));
  const auto lines = in_unit(each, unit), mean = in_unit(overlay.mean, unit), sd = in_unit(overlay.sd, unit);
  const auto [fewest, most] = std::ranges::minmax(overlay.cycles);
  const bool spread = std::ranges::any_of(sd, [](float v) { return std::isfinite(v); });
  return {{"coordinate", curves.id},
          {"side", curves.context},
          {"count", curves.count()},
          {"whole", whole},
          {"fewest", fewest},
          {"most", most},
          {"drawn", drawn.size()},
          {"each", internal::pack_curve(lines, internal::curve_step(lines, {}, usual))},
          {"mean", internal::pack_curve(mean, internal::curve_step(mean, sd, usual))},
          {"sd", spread ? internal::pack_deviations(sd) : Json(nullptr)}};
}

}  // namespace

Json cycles_json(std::span<const CycleOverlay> overlays) {
  if (overlays.empty()) return nullptr;
  Json curves = Json::array();
  for (const auto& overlay : overlays) {
    check(overlay.curves.points == overlays.front().curves.points, "overlays of a page have equal points");
    curves.push_back(overlay_json(overlay));
  }
  return {{"points", overlays.front().curves.points}, {"curves", std::move(curves)}};
}

Json cycle_spans_json(std::span<const CycleSpan> cycles) {
  if (cycles.empty()) return nullptr;
  Json out = {{"Left", Json::array()}, {"Right", Json::array()}};
  for (const auto& cycle : cycles)
    out[cycle.side == data::Side::left ? "Left" : "Right"].push_back(
        Json::array({internal::number(cycle.start_s, 6), internal::number(cycle.end_s, 6)}));
  return out;
}

}  // namespace kinemark::report
