// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/swings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

using data::Side;
using Eigen::RowVector2d;
using math::SeriesMatrix;

constexpr double kLowestShare = 0.03, kAboveLowest_m = 0.035,
                 kStill_m_per_s = 0.35;  // share of heights; above it; vertically
constexpr double kWidth_m_per_s = 0.08, kWidthOfFast = 0.03, kFast = 0.9;
constexpr std::size_t kStarts = 60, kMostSamples = 6000;
constexpr int kShifts = 12;
constexpr double kShifted = 1e-4, kBetter = 1.02;  // a later start has to gather 2 % more
constexpr double kAround_s = 0.7, kTop = 0.98, kShareOfTop = 0.25, kLeastTop_m_per_s = 0.35;
constexpr double kLeastSwing_s = 0.06, kLeastSwing_m = 0.08;
constexpr double kSwingOfStride = 1.0 / 2.3;
constexpr double kDoubled = 1.5;  // of the shorter quarter: a swing was lost between
constexpr double kLeastStride_s = 0.3, kMostStride_s = 2.5;

constexpr double kQuiet_m_per_s = 0.05, kQuiet_s = 0.7;

// Velocities of a marker while it is low and neither rises nor falls, and nobody stands.
void add_low(const SeriesMatrix& x, const FootPaths& foot, const std::vector<bool>& quiet, double rate_hz,
             std::vector<RowVector2d>& out) {
  std::vector<double> heights;
  for (Eigen::Index f = 0; f < x.rows(); ++f)
    if (foot.known[at(f)]) heights.push_back(x(f, 2));
  if (heights.empty()) return;
  const double most = math::quantile(heights, kLowestShare) + kAboveLowest_m;
  const SeriesMatrix v = slopes(x, rate_hz);
  for (Eigen::Index f = 0; f < x.rows(); ++f)
    if (foot.known[at(f)] && !quiet[at(f)] && x(f, 2) < most && std::abs(v(f, 2)) < kStill_m_per_s)
      out.emplace_back(v.row(f).leftCols<2>());
}

std::vector<RowVector2d> thinned(std::vector<RowVector2d> x) {
  const std::size_t step = x.size() / kMostSamples + 1;
  if (step == 1) return x;
  std::vector<RowVector2d> out;
  for (std::size_t i = 0; i < x.size(); i += step) out.push_back(x[i]);
  return out;
}

struct Mode {
  RowVector2d centre{0.0, 0.0};
  double weight = -1.0;
};

double weights_about(const std::vector<RowVector2d>& v, const RowVector2d& centre, double width,
                     RowVector2d& mean) {
  double weight = 0.0;
  mean.setZero();
  for (const auto& one : v) {
    const double w = std::exp(-0.5 * (one - centre).squaredNorm() / (width * width));
    weight += w, mean += w * one;
  }
  if (weight > 1e-9) mean /= weight;
  return weight;
}

Mode climb(const std::vector<RowVector2d>& v, RowVector2d centre, double width) {
  RowVector2d mean;
  for (int i = 0; i < kShifts; ++i) {
    const double weight = weights_about(v, centre, width, mean);
    const bool done = !(weight > 1e-9) || (mean - centre).norm() < kShifted;
    if (done) break;
    centre = mean;
  }
  return {.centre = centre, .weight = weights_about(v, centre, width, mean)};
}

// Within a gap, the speed of the straight line from its one side to its other.
void cross_gaps(const SeriesMatrix& middle, const std::vector<bool>& known, const FrameSpan& seen,
                double rate_hz, const RowVector2d& ground, Eigen::VectorXd& speed) {
  for (auto f = seen.first; f <= seen.last; ++f) {
    if (known[at(f)]) continue;
    auto last = f;
    while (!known[at(last + 1)]) ++last;
    const double seconds = static_cast<double>(last + 2 - f) / rate_hz;
    const RowVector2d way = (middle.row(last + 1) - middle.row(f - 1)).leftCols<2>();
    speed.segment(f, last - f + 1).setConstant((way / seconds - ground).norm());
    f = last;
  }
}

// Greatest within a number of frames to each side.
Eigen::VectorXd greatest_around(const Eigen::VectorXd& x, std::int64_t reach) {
  const auto n = x.size();
  Eigen::VectorXd out(n);
  std::vector<Eigen::Index> queue;  // descending values
  std::size_t head = 0;
  Eigen::Index next = 0;
  for (Eigen::Index f = 0; f < n; ++f) {
    for (; next < n && next <= f + reach; ++next) {
      while (queue.size() > head && x[queue.back()] <= x[next]) queue.pop_back();
      queue.push_back(next);
    }
    while (queue[head] < f - reach) ++head;
    out[f] = x[queue[head]];
  }
  return out;
}

std::vector<FrameSpan> runs_of_swing(const FootSwings& foot, const Eigen::VectorXd& usual) {
  const auto share = [&](std::int64_t f) { return foot.speed[f] / usual[f]; };
  const auto decided = [&](std::int64_t f) { return share(f) > kSwings ? 1 : share(f) < kStands ? 0 : -1; };
  auto first = foot.seen.first;
  while (first <= foot.seen.last && decided(first) < 0) ++first;
  if (first > foot.seen.last) return {};
  // Before the first frame that decides, a foot between the two thresholds does what it is about to end.
  bool swings = share(foot.seen.first) > kStands && decided(first) == 0;
  std::vector<FrameSpan> out;
  std::int64_t begun = foot.seen.first;
  for (auto f = foot.seen.first; f <= foot.seen.last; ++f) {
    const int now = f < first ? static_cast<int>(swings) : decided(f);
    if (now < 0 || (now == 1) == swings) continue;
    if (swings) out.push_back({.first = begun, .last = f - 1});
    begun = f, swings = !swings;
  }
  if (swings) out.push_back({.first = begun, .last = foot.seen.last});
  return out;
}

Swing edges_of(const FootSwings& foot, const Eigen::VectorXd& usual, const FrameSpan& run) {
  const auto share = [&](std::int64_t f) { return foot.speed[f] / usual[f]; };
  Swing out{.leaves = std::nullopt, .peak = run.first, .lands = std::nullopt};
  for (auto f = run.first; f <= run.last; ++f)
    if (share(f) > share(out.peak)) out.peak = f;
  auto low = run.first, high = out.peak;
  while (low > foot.seen.first && share(low) > kStands) --low;
  while (high < foot.seen.last && share(high) > kStands) ++high;
  if (share(low) <= kStands) out.leaves = low;
  if (share(high) <= kStands) out.lands = high;
  return out;
}

void find_swings(const GaitPaths& paths, Side side, const RowVector2d& ground, Steps& out) {
  const auto& foot = paths.foot(side);
  auto& of = out.feet[data::index_of(side)];
  const SeriesMatrix middle = 0.5 * (foot.heel + foot.toe);
  for (const auto& run : runs_of_swing(of, out.usual)) {
    if (static_cast<double>(run.count()) <= kLeastSwing_s * paths.rate_hz) continue;
    const double seconds = static_cast<double>(run.last - run.first) / paths.rate_hz;
    const RowVector2d way = (middle.row(run.last) - middle.row(run.first)).leftCols<2>() - seconds * ground;
    if (way.norm() > kLeastSwing_m || run.first == of.seen.first || run.last == of.seen.last)
      of.swings.push_back(edges_of(of, out.usual, run));
  }
}

void find_swings_of_both(const GaitPaths& paths, const RowVector2d& ground, Steps& out) {
  for (const Side side : data::kBothSides) {
    out.feet[data::index_of(side)].swings.clear();
    if (out.foot(side).speed.size() > 0) find_swings(paths, side, ground, out);
  }
}

// Greatest speed of the swing of either foot that is nearest to a frame, of those whose greatest was seen;
// NaN of none.
double nearest_peak(const Steps& steps, std::int64_t frame) {
  double out = kNaN;
  std::int64_t away = std::numeric_limits<std::int64_t>::max();
  for (const auto& foot : steps.feet)
    for (const auto& swing : foot.swings)
      if (const auto apart = std::abs(swing.peak - frame);
          swing.peak > foot.seen.first && swing.peak < foot.seen.last && apart < away)
        out = foot.speed[swing.peak], away = apart;
  return out;
}

// A foot that only slows down where it comes into sight, or only speeds up where it goes, swung as fast
// before or after as in the nearest swing: what is slow beside that is a foot that rolls.
// @return  whether the usual speed there was less
bool complete_ends(std::int64_t reach, Steps& out) {
  bool changed = false;
  for (const auto& foot : out.feet)
    for (const auto& swing : foot.swings) {
      if (swing.peak > foot.seen.first && swing.peak < foot.seen.last) continue;
      const double peak = nearest_peak(out, swing.peak);
      if (!(peak > out.usual[swing.peak])) continue;
      const auto first = std::max<std::int64_t>(0, swing.peak - reach),
                 last = std::min<std::int64_t>(out.usual.size() - 1, swing.peak + reach);
      for (auto f = first; f <= last; ++f) out.usual[f] = std::max(out.usual[f], peak);
      changed = true;
    }
  return changed;
}

double stride_of(const Steps& steps, double rate_hz) {
  std::vector<double> between, swings;
  for (const auto& foot : steps.feet) {
    for (std::size_t i = 0; i < foot.swings.size(); ++i) {
      const auto& swing = foot.swings[i];
      if (i > 0) between.push_back(static_cast<double>(swing.peak - foot.swings[i - 1].peak) / rate_hz);
      if (swing.leaves && swing.lands)
        swings.push_back(static_cast<double>(*swing.lands - *swing.leaves) / rate_hz);
    }
  }
  if (between.size() > 2) {
    const double most = kDoubled * math::quantile(between, 0.25);
    std::erase_if(between, [most](double t) { return t >= most; });
  }
  const double stride = !between.empty()  ? math::median(between)
                        : !swings.empty() ? math::median(swings) / kSwingOfStride
                                          : Steps{}.stride_s;
  return std::clamp(stride, kLeastStride_s, kMostStride_s);
}

}  // namespace

SeriesMatrix slopes(const SeriesMatrix& x, double rate_hz) {
  const auto n = x.rows();
  SeriesMatrix out = SeriesMatrix::Zero(n, x.cols());
  if (n < 2) return out;
  for (Eigen::Index f = 1; f + 1 < n; ++f) out.row(f) = 0.5 * rate_hz * (x.row(f + 1) - x.row(f - 1));
  out.row(0) = rate_hz * (x.row(1) - x.row(0));
  out.row(n - 1) = rate_hz * (x.row(n - 1) - x.row(n - 2));
  return out;
}

Eigen::VectorXd speed_over_ground(const SeriesMatrix& x, double rate_hz, const RowVector2d& ground) {
  return (slopes(x, rate_hz).leftCols<2>().rowwise() - ground).rowwise().norm();
}

std::vector<bool> quiet_frames(const GaitPaths& paths) {
  std::vector<bool> still(at(paths.frames()), true);
  for (const auto& foot : paths.feet) {
    if (!foot.present()) return std::vector<bool>(at(paths.frames()), false);
    for (const auto* marker : {&foot.heel, &foot.toe}) {
      const Eigen::VectorXd speed = speed_over_ground(*marker, paths.rate_hz, {0.0, 0.0});
      for (std::int64_t f = 0; f < paths.frames(); ++f)
        still[at(f)] = still[at(f)] && foot.known[at(f)] && speed[f] < kQuiet_m_per_s;
    }
  }
  for (std::int64_t f = 0; f < paths.frames(); ++f) {
    if (!still[at(f)]) continue;
    auto last = f;
    while (last + 1 < paths.frames() && still[at(last + 1)]) ++last;
    if (static_cast<double>(last - f + 1) < kQuiet_s * paths.rate_hz)
      for (auto k = f; k <= last; ++k) still[at(k)] = false;
    f = last;
  }
  return still;
}

Ground ground_velocity(const GaitPaths& paths, const std::optional<RowVector2d>& near) {
  std::vector<RowVector2d> heels, toes;
  const auto quiet = quiet_frames(paths);
  for (const auto& foot : paths.feet) {
    if (!foot.present()) continue;
    add_low(foot.heel, foot, quiet, paths.rate_hz, heels);
    add_low(foot.toe, foot, quiet, paths.rate_hz, toes);
  }
  std::vector<RowVector2d> v = heels;
  v.insert(v.end(), toes.begin(), toes.end());
  v = thinned(std::move(v));
  if (v.size() < 5) return {};
  std::vector<double> fast;
  for (const auto& one : v) fast.push_back(one.norm());
  const double width = std::max(kWidth_m_per_s, kWidthOfFast * math::quantile(fast, kFast));
  Mode best;
  const auto try_from = [&](const RowVector2d& start) {
    const auto mode = climb(v, start, width);
    if (mode.weight > kBetter * best.weight) best = mode;
  };
  if (near) {
    try_from(*near);
  } else {
    for (std::size_t i = 0; i < v.size(); i += std::max<std::size_t>(1, v.size() / kStarts)) try_from(v[i]);
    try_from(RowVector2d(0.0, 0.0));
  }
  RowVector2d of_heels, of_toes;
  const bool both = weights_about(heels, best.centre, width, of_heels) > 1e-9 &&
                    weights_about(toes, best.centre, width, of_toes) > 1e-9;
  return {.velocity = best.centre, .sd = both ? 0.5 * (of_heels - of_toes).norm() : width};
}

Steps find_steps(const GaitPaths& paths, const RowVector2d& ground) {
  Steps out{.quiet = quiet_frames(paths)};
  Eigen::VectorXd top = Eigen::VectorXd::Zero(paths.frames());
  for (const Side side : data::kBothSides) {
    const auto& foot = paths.foot(side);
    if (!foot.present()) continue;
    auto& of = out.feet[data::index_of(side)];
    const auto first = std::ranges::find(foot.known, true);
    if (first == foot.known.end()) continue;
    of.seen = {.first = first - foot.known.begin(), .last = paths.frames() - 1};
    while (!foot.known[at(of.seen.last)]) --of.seen.last;
    const SeriesMatrix middle = 0.5 * (foot.heel + foot.toe);
    of.speed = speed_over_ground(middle, paths.rate_hz, ground);
    cross_gaps(middle, foot.known, of.seen, paths.rate_hz, ground, of.speed);
    for (Eigen::Index f = 0; f < top.size(); ++f)
      if (out.quiet[at(f)]) of.speed[f] = 0.0;  // on a belt that stands still, too
    for (Eigen::Index f = 0; f < top.size(); ++f)
      if (foot.known[at(f)]) top[f] = std::max(top[f], of.speed[f]);
  }
  const double least = std::max(
      kLeastTop_m_per_s,
      kShareOfTop * math::quantile(std::span(top.data(), static_cast<std::size_t>(top.size())), kTop));
  const auto reach = static_cast<std::int64_t>(kAround_s * paths.rate_hz);
  out.usual = greatest_around(top, reach).cwiseMax(least);
  find_swings_of_both(paths, ground, out);
  if (complete_ends(reach, out)) find_swings_of_both(paths, ground, out);
  out.stride_s = stride_of(out, paths.rate_hz);
  out.going.assign(at(paths.frames()), false);
  const std::int64_t half = std::llround(0.5 * out.stride_s * paths.rate_hz);
  for (const auto& foot : out.feet)
    for (const auto& swing : foot.swings) {
      const auto first = std::max<std::int64_t>(0, swing.leaves.value_or(swing.peak) - half),
                 last = std::min(paths.frames() - 1, swing.lands.value_or(swing.peak) + half);
      for (auto f = first; f <= last; ++f) out.going[at(f)] = !out.quiet[at(f)];
    }
  return out;
}

double cut_off_of(double stride_s) { return std::clamp(10.0 / stride_s, 6.0, 25.0); }

}  // namespace kinemark::analysis
