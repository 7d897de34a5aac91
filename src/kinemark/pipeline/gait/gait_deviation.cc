// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "kinemark/core/index.h"

namespace kinemark::pipeline {
namespace {

using data::Side;

/// The nine, the pelvis first.
struct Scored {
  std::string_view key, title;
};
constexpr std::array kScored = {
    Scored{"pelvis_tilt", "Pelvic tilt"},          Scored{"pelvis_obliquity", "Pelvic obliquity"},
    Scored{"pelvis_rotation", "Pelvic rotation"},  Scored{"hip_flexion", "Hip flexion"},
    Scored{"hip_adduction", "Hip adduction"},      Scored{"hip_rotation", "Hip rotation"},
    Scored{"knee_flexion", "Knee flexion"},        Scored{"ankle_dorsiflexion", "Ankle dorsiflexion"},
    Scored{"foot_progression", "Foot progression"}};
constexpr std::size_t kOfPelvis = 3;

// NaN as soon as one point has no value or no norm.
double score_of(const SheetCurve& curve) {
  if (curve.norm.rows() != curve.mean.size()) return kNaN;
  return std::sqrt((curve.mean - curve.norm.col(2)).squaredNorm() / static_cast<double>(curve.mean.size()));
}

double root_mean_square(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double v : values) squares += v * v;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

GaitDeviation gait_deviation(const GaitSheet& sheet) {
  GaitDeviation out;
  std::array<std::vector<double>, 2> all;
  bool any = false;
  for (const auto& [key, title] : kScored) {
    GaitVariableScore score{.title = std::string(title)};
    const auto panel = std::ranges::find_if(sheet.panels, [&](const SheetPanel& one) {
      return one.what.key == key && one.unit == "deg" && one.what.part == SheetPart::kinematics;
    });
    for (const auto side : data::kBothSides) {
      const auto i = data::index_of(side);
      if (panel != sheet.panels.end() && panel->sides[i]) score.value_deg[i] = score_of(*panel->sides[i]);
      all[i].push_back(score.value_deg[i]);
      any = any || std::isfinite(score.value_deg[i]);
    }
    if (!std::isfinite(score.value_deg[0]) || !std::isfinite(score.value_deg[1]))
      out.lacking.emplace_back(title);
    out.scores.push_back(std::move(score));
  }
  if (!any) return {};
  for (const auto side : data::kBothSides)
    out.side_deg[data::index_of(side)] = root_mean_square(all[data::index_of(side)]);
  auto both = all[data::index_of(Side::left)];
  const auto& right = all[data::index_of(Side::right)];
  both.insert(both.end(), right.begin() + kOfPelvis, right.end());
  out.both_deg = root_mean_square(both);
  return out;
}

}  // namespace kinemark::pipeline
