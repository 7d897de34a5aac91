// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/crossings.h"

#include <algorithm>
#include <map>
#include <utility>

#include "kinemark/math/statistics.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr double kCrossed = 0.5;    // steps with exchanged labels to steps as labelled
constexpr double kLeapM = 0.008;    // a jump is at least so far from the predicted position, and
constexpr double kLeapUsual = 6.0;  // so many times the median of that
constexpr std::size_t kMaxLeaps = 40;

/// Predicted position: linear continuation of the two frames before.
Eigen::Vector3d ahead(const Recording& r, Index m, Index frame) {
  if (frame < 2 || !r.usable(m, frame - 2)) return r.x(m, frame - 1);
  return 2.0 * r.x(m, frame - 1) - r.x(m, frame - 2);
}

/// Frames of leaps and the markers that make them.
std::map<Index, std::vector<Index>> find_leaps(const Recording& r) {
  std::map<Index, std::vector<Index>> leaps;
  std::vector<double> off;
  std::vector<Index> frames;
  for (Index m = 0; m < r.markers(); ++m) {
    off.clear();
    frames.clear();
    for (Index f = 1; f < r.frames(); ++f) {
      if (!r.complete(m, f - 1, f + 1)) continue;
      off.push_back((r.x(m, f) - ahead(r, m, f)).norm());
      frames.push_back(f);
    }
    if (off.empty()) continue;
    const double least = std::max(kLeapM, kLeapUsual * math::upper_median(off));
    for (std::size_t i = 0; i < off.size(); ++i)
      if (off[i] > least) leaps[frames[i]].push_back(m);
  }
  return leaps;
}

}  // namespace

bool paths_cross(const Recording& r, Index a, Index b, Index f) {
  const Eigen::Vector3d pa = ahead(r, a, f);
  const Eigen::Vector3d pb = ahead(r, b, f);
  const double stay = (r.x(a, f) - pa).norm() + (r.x(b, f) - pb).norm();
  const double cross = (r.x(a, f) - pb).norm() + (r.x(b, f) - pa).norm();
  return cross < kCrossed * stay;
}

double median_distance(const Recording& r, Index a, Index b, Index first, Index end) {
  std::vector<double> d;
  for (Index f = first; f < end; ++f)
    if (r.usable(a, f) && r.usable(b, f)) d.push_back((r.x(a, f) - r.x(b, f)).norm());
  return d.empty() ? 0.0 : math::upper_median(d);
}

std::vector<Swap> find_crossings(const Recording& r) {
  std::map<std::pair<Index, Index>, std::vector<Index>> events;
  for (const auto& [f, markers] : find_leaps(r)) {
    if (markers.size() < 2 || markers.size() > kMaxLeaps) continue;  // all together: a jump of the clock
    for (std::size_t i = 0; i < markers.size(); ++i)
      for (std::size_t k = i + 1; k < markers.size(); ++k)
        if (paths_cross(r, markers[i], markers[k], f)) events[{markers[i], markers[k]}].push_back(f);
  }
  std::vector<Swap> swaps;
  for (const auto& [pair, frames] : events)
    for (std::size_t i = 0; i + 1 < frames.size();) {
      const bool seen = r.complete(pair.first, frames[i], frames[i + 1]) &&
                        r.complete(pair.second, frames[i], frames[i + 1]);
      if (!seen || 2 * (frames[i + 1] - frames[i]) > r.frames()) {
        ++i;
        continue;
      }
      swaps.push_back({.first_marker = pair.first,
                       .second_marker = pair.second,
                       .first = frames[i],
                       .end = frames[i + 1],
                       .distance_m = median_distance(r, pair.first, pair.second, frames[i], frames[i + 1])});
      i += 2;
    }
  return swaps;
}

}  // namespace kinemark::trajectory::internal
