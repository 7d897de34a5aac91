// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/kinematic_events.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;
using Eigen::RowVector2d;
using math::SeriesMatrix;
using Series = Eigen::VectorXd;

constexpr double kOver_s = 0.3, kMeanOver_s = 1.2;
constexpr double kRearSpeed = 0.14;  // of the usual greatest
// Windows in strides about Detector::middle.
constexpr double kStrikeBack = 0.25, kStrikeOn = 0.13, kFallBack = 0.12, kFallOn = 0.11, kOffBack = 0.16,
                 kOffOn = 0.16, kRearBack = 0.1, kOfStance = 0.25, kAgain = 0.1;
constexpr double kLeastFall = 0.3;  // of the fastest fall in the window
constexpr Eigen::Index kLeastWindow = 4;
constexpr double kEdge_s = 0.05;

double refined(const Series& y, Eigen::Index k) {
  if (k <= 0 || k + 1 >= y.size()) return static_cast<double>(k);
  const double bent = y[k - 1] - 2.0 * y[k] + y[k + 1];
  return static_cast<double>(k) +
         (bent != 0.0 ? std::clamp(0.5 * (y[k - 1] - y[k + 1]) / bent, -0.5, 0.5) : 0.0);
}

// A frame, between two neighbours, at which a series passes a level; all in [first, last].
std::vector<double> crossings(const Series& y, double level, Eigen::Index first, Eigen::Index last,
                              bool down) {
  std::vector<double> out;
  for (Eigen::Index k = std::max<Eigen::Index>(first, 0); k < std::min<Eigen::Index>(last, y.size() - 1); ++k)
    if (down ? (y[k] >= level && level > y[k + 1]) : (y[k] <= level && level < y[k + 1]))
      out.push_back(static_cast<double>(k) + (level - y[k]) / (y[k + 1] - y[k]));
  return out;
}

std::vector<Eigen::Index> peaks(const Series& y, double first, double last) {
  std::vector<Eigen::Index> out;
  const auto from = static_cast<Eigen::Index>(std::max(first, 1.0)),
             to = std::min(static_cast<Eigen::Index>(last), y.size() - 2);
  for (Eigen::Index k = from; k <= to; ++k)
    if (y[k] >= y[k - 1] && y[k] > y[k + 1]) out.push_back(k);
  return out;
}

// The last peak that is no ripple.
double last_peak(const Series& y, double first, double last) {
  const auto all = peaks(y, first, last);
  if (all.empty()) return kNaN;
  double most = -INFINITY;
  for (const auto k : all) most = std::max(most, y[k]);
  double out = kNaN;
  for (const auto k : all)
    if (y[k] >= kLeastFall * most) out = refined(y, k);
  return out;
}

double highest_peak(const Series& y, double first, double last) {
  const auto all = peaks(y, first, last);
  if (all.empty()) return kNaN;
  return refined(y, *std::ranges::max_element(all, {}, [&](auto k) { return y[k]; }));
}

// The greatest value within a window; NaN at its ends, where it is no turn.
double greatest(const Series& y, Eigen::Index first, Eigen::Index last) {
  Eigen::Index k = 0;
  y.segment(first, last - first + 1).maxCoeff(&k);
  const double out = refined(y, first + k);
  return out > static_cast<double>(first) + 0.01 && out < static_cast<double>(last) - 0.01 ? out : kNaN;
}

// Series of one foot that the detectors look at.
class FootSignals {
 public:
  FootSignals(const GaitPaths& paths, const Steps& steps, const RowVector2d& ground, const Progress& progress,
              Side side)
      : paths_(paths), steps_(steps), side_(side), foot_(paths.foot(side)) {
    const SeriesMatrix middle = 0.5 * (foot_.heel + foot_.toe);
    rise_ = slopes(middle, paths.rate_hz).col(2);
    rear_ = speed_over_ground(foot_.heel, paths.rate_hz, ground);
    share_ = speed_over_ground(middle, paths.rate_hz, ground).cwiseQuotient(steps.usual);
    const auto before = [&](const SeriesMatrix& x) {
      return Series((x - paths.pelvis).leftCols<2>().cwiseProduct(progress.direction).rowwise().sum());
    };
    heel_before_ = before(foot_.heel);
    toe_behind_ = -before(foot_.toe);
    stride_ = steps.stride_s * paths.rate_hz;
  }

  [[nodiscard]] SwingEdge strike(std::size_t i, double c) const {
    const auto& swings = steps_.foot(side_).swings;
    const auto& swing = swings[i];
    auto out = begin(FootEvent::strike, i, c);
    // Not beyond the middle of the stance that follows.
    double until = static_cast<double>(frames() - 1);
    if (i + 1 < swings.size())
      until = 0.5 * static_cast<double>(*swing.lands + swings[i + 1].leaves.value_or(*swing.lands));
    until = std::min(until, static_cast<double>(*swing.lands) + kOfStance * stride_);
    const auto first = known_back(c, std::max(static_cast<double>(swing.peak), c - kStrikeBack * stride_)),
               last = known_on(c, std::min(until, c + kStrikeOn * stride_));
    if (last - first < kLeastWindow) return out;
    set(out, Detector::vertical,
        last_peak(-rise_, std::max(static_cast<double>(first), c - kFallBack * stride_),
                  std::min(static_cast<double>(known_on(c, c + kFallOn * stride_)), c + kFallOn * stride_)));
    set(out, Detector::pelvis, against_pelvis(heel_before_, first, last));
    const auto slow =
        crossings(rear_, kRearSpeed * steps_.usual[*swing.lands], first_known(swing.peak, first), last, true);
    set(out, Detector::rear, slow.empty() ? kNaN : slow.back());
    return out;
  }

  [[nodiscard]] SwingEdge off(std::size_t i, double c) const {
    const auto& swings = steps_.foot(side_).swings;
    const auto& swing = swings[i];
    auto out = begin(FootEvent::off, i, c);
    double from = 0.0;  // not before the middle of the stance
    const auto leaves = static_cast<double>(*swing.leaves);
    if (i > 0) from = 0.5 * (leaves + static_cast<double>(swings[i - 1].lands.value_or(*swing.leaves)));
    from = std::max({0.0, from, leaves - kOfStance * stride_});
    const auto first = known_back(c, std::max(from, c - kOffBack * stride_)),
               last = known_on(c, std::min(static_cast<double>(swing.peak), c + kOffOn * stride_));
    if (last - first < kLeastWindow) return out;
    set(out, Detector::vertical, highest_peak(rise_, static_cast<double>(first), static_cast<double>(last)));
    set(out, Detector::pelvis, against_pelvis(toe_behind_, first, last));
    const auto fast = crossings(rear_, kRearSpeed * steps_.usual[*swing.leaves],
                                known_back(c, static_cast<double>(first) - kRearBack * stride_), last, false);
    set(out, Detector::rear, fast.empty() ? kNaN : fast.back());
    return out;
  }

  // Passings of kStands nearest to a frame.
  [[nodiscard]] double nearest_passing(FootEvent what, double frame, double reach) const {
    double out = kNaN;
    for (const double c : crossings(share_, kStands, static_cast<Eigen::Index>(frame - reach),
                                    static_cast<Eigen::Index>(frame + reach) + 2, what == FootEvent::strike))
      if (!(std::abs(c - frame) >= std::abs(out - frame))) out = c;
    return out;
  }

 private:
  [[nodiscard]] Eigen::Index frames() const { return rise_.size(); }
  [[nodiscard]] bool known(Eigen::Index f) const { return f >= 0 && f < frames() && foot_.known[at(f)]; }

  // From an instant back to a frame, as far as the foot is known.
  [[nodiscard]] Eigen::Index known_back(double c, double to) const {
    auto f = static_cast<Eigen::Index>(c);
    while (f - 1 >= static_cast<Eigen::Index>(std::max(to, 0.0)) && known(f - 1)) --f;
    return f;
  }
  [[nodiscard]] Eigen::Index known_on(double c, double to) const {
    auto f = std::min(static_cast<Eigen::Index>(c), frames() - 1);
    while (f + 1 <= static_cast<Eigen::Index>(to) && known(f + 1)) ++f;
    return f;
  }
  [[nodiscard]] Eigen::Index first_known(Eigen::Index wanted, Eigen::Index known_from) const {
    auto f = known_from;
    while (f > wanted && known(f - 1)) --f;
    return f;
  }

  [[nodiscard]] double against_pelvis(const Series& y, Eigen::Index first, Eigen::Index last) const {
    for (auto f = first; f <= last; ++f)
      if (!paths_.pelvis_known[at(f)]) return kNaN;
    return greatest(y, first, last);
  }

  [[nodiscard]] SwingEdge begin(FootEvent what, std::size_t i, double c) const {
    SwingEdge out{.side = side_, .what = what, .swing = i, .frame = c};
    out.after_s = {kNaN, kNaN, kNaN, 0.0};
    const auto near = static_cast<Eigen::Index>(c);
    const auto reach = std::max<Eigen::Index>(2, static_cast<Eigen::Index>(kEdge_s * paths_.rate_hz));
    for (const Eigen::Index f : {near - 1, near, near + 1, near + 2})
      if (f >= 0 && f < frames()) out.seen = out.seen && known(f);
    for (auto f = near - reach; f <= near + reach; ++f)
      if (f >= 0 && f < frames()) out.at_gap = out.at_gap || !known(f);
    const double edge = kEdge_s * paths_.rate_hz;
    out.at_end = c < edge || c > static_cast<double>(frames() - 1) - edge;
    return out;
  }

  void set(SwingEdge& out, Detector detector, double frame) const {
    out.after_s[static_cast<std::size_t>(detector)] = (frame - out.frame) / paths_.rate_hz;
  }

  const GaitPaths& paths_;
  const Steps& steps_;
  Side side_;
  const FootPaths& foot_;
  Series rise_, rear_, share_, heel_before_, toe_behind_;
  double stride_ = 0.0;
};

}  // namespace

Progress progress_of(const GaitPaths& paths, const RowVector2d& ground) {
  const auto n = paths.frames();
  const auto reach = std::max<Eigen::Index>(1, std::llround(0.5 * kOver_s * paths.rate_hz));
  const auto around = std::max<Eigen::Index>(1, std::llround(0.5 * kMeanOver_s * paths.rate_hz));
  const auto over = [&](Eigen::Index f, Eigen::Index half) {
    const auto first = std::max<Eigen::Index>(0, f - half), last = std::min<Eigen::Index>(n - 1, f + half);
    return RowVector2d((paths.pelvis.row(last) - paths.pelvis.row(first)).leftCols<2>() * paths.rate_hz /
                           static_cast<double>(std::max<Eigen::Index>(1, last - first)) -
                       ground);
  };
  Progress out{.velocity = SeriesMatrix(n, 2), .direction = SeriesMatrix(n, 2)};
  RowVector2d before(1.0, 0.0);
  for (Eigen::Index f = 0; f < n; ++f) {
    out.velocity.row(f) = over(f, reach);
    const RowVector2d mean = over(f, around);
    if (mean.norm() > 1e-6) before = mean.normalized();
    out.direction.row(f) = before;
  }
  return out;
}

std::vector<SwingEdge> find_edges(const GaitPaths& paths, const Steps& steps, const RowVector2d& ground,
                                  const Progress& progress) {
  std::vector<SwingEdge> out;
  for (const Side side : data::kBothSides) {
    if (steps.foot(side).speed.size() == 0) continue;
    const FootSignals signals(paths, steps, ground, progress, side);
    const auto& swings = steps.foot(side).swings;
    for (std::size_t i = 0; i < swings.size(); ++i) {
      if (swings[i].leaves) {
        const auto frame = static_cast<double>(*swings[i].leaves);
        const double c = signals.nearest_passing(FootEvent::off, frame, 1.0);
        out.push_back(signals.off(i, std::isfinite(c) ? c : frame));
      }
      if (swings[i].lands) {
        const auto frame = static_cast<double>(*swings[i].lands);
        const double c = signals.nearest_passing(FootEvent::strike, frame, 1.0);
        out.push_back(signals.strike(i, std::isfinite(c) ? c : frame));
      }
    }
  }
  return out;
}

std::vector<SwingEdge> find_edges_again(const GaitPaths& paths, const Steps& steps, const RowVector2d& ground,
                                        const std::vector<SwingEdge>& edges) {
  std::vector<SwingEdge> out;
  const auto progress = progress_of(paths, ground);
  for (const Side side : data::kBothSides) {
    if (steps.foot(side).speed.size() == 0) continue;
    const FootSignals signals(paths, steps, ground, progress, side);
    for (const auto& edge : edges) {
      if (edge.side != side) continue;
      const double c =
          signals.nearest_passing(edge.what, edge.frame, kAgain * steps.stride_s * paths.rate_hz);
      if (!std::isfinite(c)) {
        auto lost = edge;
        lost.frame = kNaN;
        out.push_back(lost);
      } else {
        out.push_back(edge.what == FootEvent::strike ? signals.strike(edge.swing, c)
                                                     : signals.off(edge.swing, c));
      }
    }
  }
  return out;
}

}  // namespace kinemark::analysis
