// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Whether the feet run, from swings and the pelvis.
#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/gait/gait_kind.h"
#include "kinemark/stages/analysis/gait/kinematic_events.h"

namespace kinemark::analysis {
namespace {

constexpr double kFlight = 0.03, kBounce_m = 0.01, kShortStance = 0.45, kNoWalk_m_per_s = 2.2;
constexpr double kQuarter = 0.25;  // of a stride

}  // namespace

bool RunEvidence::runs() const {
  if (!(flight_share > kFlight)) return false;
  if (std::isfinite(bounce_m)) return bounce_m < kBounce_m;
  return stance_share < kShortStance || speed_m_per_s > kNoWalk_m_per_s;
}

RunEvidence run_evidence(const GaitPaths& paths, const Steps& steps, const Eigen::RowVector2d& ground) {
  RunEvidence out;
  std::int64_t first = 0, last = paths.frames() - 1;
  const auto goes = [&](std::int64_t f) { return paths.pelvis_known[at(f)] && steps.going[at(f)]; };
  while (first < last && !goes(first)) ++first;
  while (last > first && !goes(last)) --last;
  if (last > first)
    out.speed_m_per_s = ((paths.pelvis.row(last) - paths.pelvis.row(first)).leftCols<2>() * paths.rate_hz /
                             static_cast<double>(last - first) -
                         ground)
                            .norm();
  std::vector<double> bounces, swings;
  const auto quarter = static_cast<std::int64_t>(kQuarter * steps.stride_s * paths.rate_hz);
  for (const auto& foot : steps.feet)
    for (std::size_t i = 0; i < foot.swings.size(); ++i) {
      const auto& swing = foot.swings[i];
      if (swing.leaves && swing.lands)
        swings.push_back(static_cast<double>(*swing.lands - *swing.leaves) / paths.rate_hz);
      if (i + 1 == foot.swings.size() || !swing.lands || !foot.swings[i + 1].leaves) continue;
      const auto middle = (*swing.lands + *foot.swings[i + 1].leaves) / 2;
      if (*foot.swings[i + 1].leaves <= *swing.lands || middle < quarter ||
          middle + quarter >= paths.frames())
        continue;
      bounces.push_back(paths.pelvis(middle, 2) -
                        0.5 * (paths.pelvis(middle - quarter, 2) + paths.pelvis(middle + quarter, 2)));
    }
  if (!bounces.empty()) out.bounce_m = math::median(bounces);
  if (!swings.empty()) out.stance_share = 1.0 - math::median(swings) / steps.stride_s;
  if (steps.feet[0].speed.size() == 0 || steps.feet[1].speed.size() == 0) return out;
  std::int64_t both = 0;
  for (std::int64_t f = 0; f < paths.frames(); ++f)
    both += steps.going[at(f)] && std::ranges::all_of(data::kBothSides, [&](data::Side side) {
              return paths.foot(side).known[at(f)] && steps.foot(side).speed[f] > kStands * steps.usual[f];
            });
  out.flight_share =
      static_cast<double>(both) / std::max(1.0, static_cast<double>(std::ranges::count(steps.going, true)));
  return out;
}

}  // namespace kinemark::analysis
