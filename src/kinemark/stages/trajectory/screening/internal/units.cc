// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/trajectory/screening/internal/defects.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr double kThousand = 1000.0;
constexpr double kNeighbour = 1.0;  // m, on the same body

struct Extent {
  double distance = 0.0;  ///< median distance from the origin, m
  double spread = 0.0;    ///< median distance from its own middle, m
};

Extent extent_of(const data::Trajectories& t, std::int64_t marker) {
  std::vector<double> distance;
  std::array<std::vector<double>, 3> axis;
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    if (!t.present(f, marker)) continue;
    distance.push_back(t.x(f, marker).norm());
    for (std::size_t a = 0; a < 3; ++a) axis[a].push_back(t.x(f, marker)(static_cast<int>(a)));
  }
  const Eigen::Vector3d middle(median_of(axis[0]), median_of(axis[1]), median_of(axis[2]));
  Extent e;
  e.distance = median_of(distance);
  for (double& d : distance) d = 0.0;
  std::size_t i = 0;
  for (std::int64_t f = 0; f < t.frames(); ++f)
    if (t.present(f, marker)) distance[i++] = (t.x(f, marker) - middle).norm();
  e.spread = median_of(distance);
  return e;
}

/// 1 when `b` is a thousand times `a` and in its direction, -1 for the reverse, else 0.
int slip_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const auto alike = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    return (p - q).norm() < 0.05 * p.norm();
  };
  if (alike(a, b / kThousand)) return 1;
  if (alike(a, b * kThousand)) return -1;
  return 0;
}

/// Slips with time: the part that is in another unit than most of the marker.
void find_slips_in_time(const data::Trajectories& t, std::int64_t m, Defects& out) {
  std::vector<std::pair<std::int64_t, int>> levels{{0, 0}};  // from frame: power of a thousand
  std::int64_t last = -1;
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    if (!t.present(f, m)) continue;
    if (last >= 0)
      if (const int slip = slip_between(t.x(last, m), t.x(f, m)); slip != 0)
        levels.emplace_back(f, levels.back().second + slip);
    last = f;
  }
  if (levels.size() == 1) return;
  std::vector<std::pair<int, std::int64_t>> share;  // frames at each level
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::int64_t end = i + 1 < levels.size() ? levels[i + 1].first : t.frames();
    const auto at = std::ranges::find(share, levels[i].second, &std::pair<int, std::int64_t>::first);
    if (at == share.end())
      share.emplace_back(levels[i].second, end - levels[i].first);
    else
      at->second += end - levels[i].first;
  }
  const int usual = std::ranges::max_element(share, {}, &std::pair<int, std::int64_t>::second)->first;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (levels[i].second == usual) continue;
    const std::int64_t end = i + 1 < levels.size() ? levels[i + 1].first : t.frames();
    const bool large = levels[i].second > usual;
    out.push_back({.kind = FindingKind::unit_slip,
                   .marker = m,
                   .first_frame = levels[i].first,
                   .last_frame = end - 1,
                   .size = large ? kThousand : 1.0 / kThousand,
                   .confidence = 0.99,
                   .description = fmt::format(
                       "marker '{}' is a thousand times too {} in {}: times or divided by 1000 it "
                       "joins the frames beside",
                       t.names[static_cast<std::size_t>(m)], large ? "large" : "small",
                       describe_frames(t.time, levels[i].first, end - 1))});
  }
}

/// True when some other marker goes along with this one once it is scaled: their distance hardly changes.
/// Forces and angles that a file stores as points are small or large, but do not move with any marker.
bool goes_along(const data::Trajectories& t, std::int64_t marker, double scale, double spread) {
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    if (m == marker) continue;
    std::vector<double> distance;
    for (std::int64_t f = 0; f < t.frames(); ++f)
      if (t.present(f, marker) && t.present(f, m))
        distance.push_back((scale * t.x(f, marker) - t.x(f, m)).norm());
    if (distance.size() < 10) continue;
    const double middle = median_of(distance);
    for (double& d : distance) d = std::abs(d - middle);
    if (middle < kNeighbour && median_of(distance) < 0.1 * spread) return true;
  }
  return false;
}

/// Defects of all markers over the same frames are one defect of the recording.
void merge_common(const data::Trajectories& t, Defects& slips) {
  for (std::size_t i = 0; i < slips.size(); ++i) {
    if (slips[i].marker < 0) continue;
    std::int64_t with = 0;
    std::int64_t seen = 0;
    const auto same = [&](const Defect& f) {
      return f.first_frame == slips[i].first_frame && f.last_frame == slips[i].last_frame && f.marker >= 0;
    };
    for (std::int64_t m = 0; m < t.markers(); ++m) seen += t.present(slips[i].first_frame, m) ? 1 : 0;
    with = std::ranges::count_if(slips, same);
    if (with < 2 || with < seen) continue;
    Defect all = slips[i];
    all.marker = -1;
    all.description = fmt::format("all {} markers that are seen change by a factor of a thousand in {}", seen,
                                  describe_frames(t.time, all.first_frame, all.last_frame));
    const Defect key = slips[i];
    std::erase_if(slips, [&](const Defect& f) {
      return f.first_frame == key.first_frame && f.last_frame == key.last_frame && f.marker >= 0;
    });
    slips.insert(slips.begin() + static_cast<std::ptrdiff_t>(std::min(i, slips.size())), all);
  }
}

}  // namespace

void find_unit_slips(const data::Trajectories& t, Defects& out) {
  Defects slips;
  for (std::int64_t m = 0; m < t.markers(); ++m) find_slips_in_time(t, m, slips);
  merge_common(t, slips);
  std::vector<Extent> extents;
  std::vector<double> distances;
  std::vector<double> spreads;
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    extents.push_back(extent_of(t, m));
    if (extents.back().distance > 0.0) {
      distances.push_back(extents.back().distance);
      spreads.push_back(extents.back().spread);
    }
  }
  const double distance = median_of(distances);
  const double spread = median_of(spreads);
  const auto near = [](double ratio, double factor, double tolerance) {
    return ratio > factor / tolerance && ratio < factor * tolerance;
  };
  for (std::int64_t m = 0; m < t.markers() && distances.size() >= 4; ++m) {
    const Extent& e = extents[static_cast<std::size_t>(m)];
    for (const double factor : {kThousand, 1.0 / kThousand}) {
      if (!near(e.distance / distance, factor, 3.0) || !near(e.spread / spread, factor, 10.0)) continue;
      if (!goes_along(t, m, 1.0 / factor, spread)) continue;
      slips.push_back({.kind = FindingKind::unit_slip,
                       .marker = m,
                       .first_frame = 0,
                       .last_frame = t.frames() - 1,
                       .size = factor,
                       .confidence = 0.85,
                       .description = fmt::format(
                           "marker '{}' is {:.3g} m from the origin and moves by {:.3g} m; the others "
                           "{:.3g} m and {:.3g} m: another unit",
                           t.names[static_cast<std::size_t>(m)], e.distance, e.spread, distance, spread)});
    }
  }
  // Markers are neither 200 m away nor all within 2 mm of the origin.
  if (!distances.empty() && (distance > 200.0 || (distance < 0.002 && distance > 0.0)))
    slips.push_back(
        {.kind = FindingKind::unit_slip,
         .first_frame = 0,
         .last_frame = t.frames() - 1,
         .confidence = 0.7,
         .description = fmt::format("markers are {:.3g} m from the origin (median): the unit of the whole "
                                    "recording is wrong by a thousand or so",
                                    distance)});
  out.insert(out.end(), slips.begin(), slips.end());
}

}  // namespace kinemark::trajectory::internal
