// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/kinematic_events.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;
using Series = Eigen::VectorXd;

constexpr double kLeastSwing_m = 0.15;  // of one foot against the other, each way
constexpr double kShareOfSwing = 0.4;   // of the median swing: less is no step
constexpr double kEdge_s = 0.03;        // of the recording
constexpr double kThreshold_m_per_s = 0.5;
constexpr double kLowHeel = 0.35;  // of the range of its height: a heel that comes down is not higher
constexpr double kExcluded = -1e9;
// Windows around the frames at which a foot is farthest before and behind, in cycles.
constexpr double kStrikeBefore = 0.12, kStrikeAfter = 0.15, kOffBefore = 0.06, kOffAfter = 0.22;
// Of a stance, from where the foot is farthest before: it lies flat.
constexpr double kFlatFrom = 0.15, kFlatTo = 0.28;

Series central_slope(const Series& y, double rate_hz) {
  const auto n = y.size();
  Series out = Series::Zero(n);
  for (Eigen::Index i = 1; i + 1 < n; ++i) out[i] = 0.5 * rate_hz * (y[i + 1] - y[i - 1]);
  if (n > 2) out[0] = out[1], out[n - 1] = out[n - 2];
  return out;
}

// Where the parabola through a sample and its neighbours has its extreme.
double refined(const Series& y, Eigen::Index i) {
  const double bent = y[i - 1] - 2.0 * y[i] + y[i + 1];
  return static_cast<double>(i) + (bent != 0.0 ? 0.5 * (y[i - 1] - y[i + 1]) / bent : 0.0);
}

// A frame between two neighbours at which a line reaches a value.
double crossing(const Series& y, Eigen::Index i, double value) {
  return static_cast<double>(i) + (value - y[i]) / (y[i + 1] - y[i]);
}

Series along(const math::SeriesMatrix& x, const math::SeriesMatrix& forward) {
  return x.leftCols<2>().cwiseProduct(forward).rowwise().sum();
}

// Of the largest value within a window, not at its ends.
std::optional<double> largest_within(const Series& y, const StepWindow& window) {
  const auto first = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::ceil(window.first)));
  const auto last = std::min<Eigen::Index>(y.size() - 2, static_cast<Eigen::Index>(std::floor(window.last)));
  std::optional<Eigen::Index> best;
  for (Eigen::Index i = first; i <= last; ++i)
    if (y[i - 1] > kExcluded && y[i + 1] > kExcluded && y[i] >= y[i - 1] && y[i] > y[i + 1] &&
        (!best || y[i] > y[*best]))
      best = i;
  if (!best) return std::nullopt;
  return refined(y, *best);
}

// Extremes in turn, each differing from the one before by at least `least`.
struct Turn {
  Eigen::Index frame;
  bool high;
};
std::vector<Turn> turns_of(const Series& y, double least) {
  std::vector<Turn> out;
  Eigen::Index low = 0, high = 0;
  int sought = 0;  // 1: a high one, -1: a low one, 0: either
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    if (y[i] > y[high]) high = i;
    if (y[i] < y[low]) low = i;
    if (sought >= 0 && y[high] - y[i] > least) {
      out.push_back({high, true});
      sought = -1, low = i;
    } else if (sought <= 0 && y[i] - y[low] > least) {
      out.push_back({low, false});
      sought = 1, high = i;
    }
  }
  // The last needs no turn back, only to lie within.
  if (sought != 0) out.push_back({sought > 0 ? high : low, sought > 0});
  return out;
}

bool known_at(const FootPaths& foot, double frame) {
  const auto i = static_cast<std::int64_t>(std::llround(frame));
  return i >= 0 && i < static_cast<std::int64_t>(foot.known.size()) && foot.known[at(i)];
}

// Speed over the ground in the plane of walking and the vertical.
Series sagittal_speed(const GaitPaths& paths, const math::SeriesMatrix& x, const Eigen::RowVector2d& ground) {
  Series out(x.rows());
  const Series vx = central_slope(x.col(0), paths.rate_hz), vy = central_slope(x.col(1), paths.rate_hz),
               vz = central_slope(x.col(2), paths.rate_hz);
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    out[i] = std::hypot((vx[i] - ground[0]) * paths.forward(i, 0) + (vy[i] - ground[1]) * paths.forward(i, 1),
                        vz[i]);
  return out;
}

// The signal whose largest value, or crossing of the threshold, is the event.
std::optional<Series> signal_of(const GaitPaths& paths, const FootPaths& foot, FootEvent what,
                                EventMethod method, const Eigen::RowVector2d& ground) {
  const bool strike = what == FootEvent::strike;
  switch (method) {
    case EventMethod::foot_velocity: {
      Series v = central_slope(0.5 * (foot.heel.col(2) + foot.toe.col(2)), paths.rate_hz);
      if (!strike) return v;
      v = -v;
      const auto height = foot.heel.col(2);
      const double low = height.minCoeff(), most = low + kLowHeel * (height.maxCoeff() - low);
      for (Eigen::Index i = 0; i < v.size(); ++i)
        if (height[i] > most) v[i] = kExcluded;
      return v;
    }
    case EventMethod::coordinates: {
      if (paths.pelvis.rows() == 0) return std::nullopt;
      const Series before = along((strike ? foot.heel : foot.toe) - paths.pelvis, paths.forward);
      return strike ? before : Series(-before);
    }
    case EventMethod::speed_threshold:
      if (!ground.allFinite()) return std::nullopt;
      return sagittal_speed(paths, strike ? foot.heel : foot.toe, ground);
  }
  return std::nullopt;
}

// Strike: the last frame in the window at which the speed falls; off: the first at which it rises.
std::optional<double> threshold_within(const Series& y, FootEvent what, const StepWindow& window) {
  const auto first = std::max<Eigen::Index>(0, static_cast<Eigen::Index>(std::ceil(window.first)));
  const auto last = std::min<Eigen::Index>(y.size() - 2, static_cast<Eigen::Index>(std::floor(window.last)));
  for (Eigen::Index k = first; k <= last; ++k) {
    const bool strike = what == FootEvent::strike;
    const auto i = strike ? last - (k - first) : k;
    const bool falls = y[i] >= kThreshold_m_per_s && y[i + 1] < kThreshold_m_per_s;
    const bool rises = y[i] < kThreshold_m_per_s && y[i + 1] >= kThreshold_m_per_s;
    if (strike ? falls : rises) return crossing(y, i, kThreshold_m_per_s);
  }
  return std::nullopt;
}

}  // namespace

std::string_view to_string(EventMethod method) {
  switch (method) {
    case EventMethod::foot_velocity:
      return "O'Connor 2007";
    case EventMethod::coordinates:
      return "Zeni 2008";
    case EventMethod::speed_threshold:
      break;
  }
  return "Ghoussayni 2004";
}

FootSwings find_swings(const GaitPaths& paths, Side side) {
  FootSwings out;
  const auto &foot = paths.foot(side), &other = paths.foot(data::opposite(side));
  if (!foot.present() || (!other.present() && paths.pelvis.rows() == 0)) return out;
  const math::SeriesMatrix middle = 0.5 * (foot.heel + foot.toe);
  const math::SeriesMatrix from =
      other.present() ? math::SeriesMatrix(0.5 * (other.heel + other.toe)) : paths.pelvis;
  const Series before = along(middle - from, paths.forward);
  auto turns = turns_of(before, kLeastSwing_m);
  std::vector<double> swings;
  for (std::size_t i = 0; i + 1 < turns.size(); ++i)
    swings.push_back(std::abs(before[turns[i + 1].frame] - before[turns[i].frame]));
  if (swings.empty()) return out;
  turns = turns_of(before, std::max(kLeastSwing_m, kShareOfSwing * math::median(swings)));
  // The first and the last may be where the recording begins or ends, which is no turn.
  const double edge = kEdge_s * paths.rate_hz, last = static_cast<double>(before.size() - 1) - edge;
  std::erase_if(turns, [&](const Turn& turn) {
    return static_cast<double>(turn.frame) < edge || static_cast<double>(turn.frame) > last;
  });
  std::vector<double> halves;  // from farthest before to farthest behind and back
  for (std::size_t i = 0; i + 1 < turns.size(); ++i)
    halves.push_back(static_cast<double>(turns[i + 1].frame - turns[i].frame));
  if (halves.empty()) return out;
  out.cycle = 2.0 * math::median(halves);
  for (const auto& turn : turns) {
    const auto centre = static_cast<double>(turn.frame);
    const double back = out.cycle * (turn.high ? kStrikeBefore : kOffBefore),
                 on = out.cycle * (turn.high ? kStrikeAfter : kOffAfter);
    out.windows[turn.high ? 0 : 1].push_back({.centre = centre, .first = centre - back, .last = centre + on});
  }
  return out;
}

Ground ground_velocity(const GaitPaths& paths, const std::array<FootSwings, 2>& swings) {
  std::array<std::vector<double>, 2> mean, apart;  // of heel and toe, by axis
  for (const Side side : data::kBothSides) {
    const auto& foot = paths.foot(side);
    const auto& of = swings[data::index_of(side)];
    for (const auto& window : of.of(FootEvent::strike)) {
      const auto first = static_cast<Eigen::Index>(std::llround(window.centre + kFlatFrom * of.cycle)),
                 last = static_cast<Eigen::Index>(std::llround(window.centre + kFlatTo * of.cycle));
      if (first < 0 || last >= paths.frames() || last <= first ||
          !known_at(foot, static_cast<double>(first)) || !known_at(foot, static_cast<double>(last)))
        continue;
      const double per_s = paths.rate_hz / static_cast<double>(last - first);
      const Eigen::RowVector3d heel = per_s * (foot.heel.row(last) - foot.heel.row(first)),
                               toe = per_s * (foot.toe.row(last) - foot.toe.row(first));
      for (const Eigen::Index axis : {0, 1}) {
        mean[at(axis)].push_back(0.5 * (heel[axis] + toe[axis]));
        apart[at(axis)].push_back(heel[axis] - toe[axis]);
      }
    }
  }
  Ground out;
  if (mean[0].empty()) return out;
  out.velocity = {math::median(mean[0]), math::median(mean[1])};
  out.sd = 0.5 * std::hypot(math::median(apart[0]), math::median(apart[1]));
  return out;
}

std::vector<double> find_in_windows(const GaitPaths& paths, Side side, FootEvent what, EventMethod method,
                                    const FootSwings& swings, const Eigen::RowVector2d& ground) {
  std::vector<double> out(swings.of(what).size(), kNaN);
  const auto& foot = paths.foot(side);
  if (out.empty()) return out;
  const auto signal = signal_of(paths, foot, what, method, ground);
  if (!signal) return out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto& window = swings.of(what)[i];
    const auto frame = method == EventMethod::speed_threshold ? threshold_within(*signal, what, window)
                                                              : largest_within(*signal, window);
    if (frame && known_at(foot, *frame)) out[i] = *frame;
  }
  return out;
}

}  // namespace kinemark::analysis
