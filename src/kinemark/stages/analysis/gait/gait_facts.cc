// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_facts.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/gait/gait_paths.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;
using Eigen::Vector2d;

constexpr double kLeastCycle_s = 0.3, kMostCycle_s = 6.0, kMostOfMedian = 1.6;
constexpr double kPrintFrom = 0.2, kPrintTo = 0.45;  // of the stance
constexpr double kUsualStance = 0.6;                 // of the cycle

using Times = std::array<std::array<std::vector<double>, 2>, 2>;  // by side and kind, ascending

// The first time within an open interval; NaN of none.
double first_between(const std::vector<double>& times, double after, double before) {
  const auto found = std::ranges::upper_bound(times, after);
  return found != times.end() && *found < before ? *found : kNaN;
}

Footprint print_of(const GaitPaths& paths, const FootPaths& foot, double strike_s, double stance_s,
                   const Eigen::RowVector2d& ground) {
  if (!foot.present() || !std::isfinite(strike_s + stance_s)) return {};
  const auto frame = [&](double t) { return std::llround((t - paths.start_s) * paths.rate_hz); };
  const auto first = frame(strike_s + kPrintFrom * stance_s), last = frame(strike_s + kPrintTo * stance_s);
  if (first < 0 || last >= paths.frames()) return {};
  Vector2d sum = Vector2d::Zero();
  double squares = 0.0;
  const Vector2d about = foot.heel.row(first).leftCols<2>().transpose();
  for (auto f = first; f <= last; ++f) {
    if (!foot.known[at(f)]) return {};
    const Vector2d x = foot.heel.row(f).leftCols<2>().transpose() - about -
                       static_cast<double>(f - first) / paths.rate_hz * ground.transpose();
    sum += x, squares += x.squaredNorm();
  }
  const auto n = static_cast<double>(last - first + 1);
  const Vector2d mean = sum / n, carried = static_cast<double>(first) / paths.rate_hz * ground.transpose();
  return {.x = about + mean - carried,
          .sd = std::sqrt(std::max(0.0, 0.5 * (squares / n - mean.squaredNorm())))};
}

Times times_of(std::span<const data::GaitEvent> events) {
  Times out;
  for (const auto& event : events)
    if (std::isfinite(event.time_s))
      out[data::index_of(event.side)][data::index_of(event.what)].push_back(event.time_s);
  for (auto& side : out)
    for (auto& kind : side) std::ranges::sort(kind);
  return out;
}

// A strike's stance: to the foot's leaving before its next strike, else the usual share of a cycle.
double stance_of(const Times& times, Side side, double strike_s, double cycle_s) {
  const double off = first_between(times[data::index_of(side)][data::index_of(FootEvent::off)], strike_s,
                                   strike_s + cycle_s);
  return std::isfinite(off) ? off - strike_s : kUsualStance * cycle_s;
}

}  // namespace

double GaitCycle::step_length() const {
  return (other_print.x - print.x).dot((next_print.x - print.x).normalized());
}

double GaitCycle::step_width() const {
  const Vector2d along = (next_print.x - print.x).normalized(), across = other_print.x - print.x;
  const double to_the_left = along.x() * across.y() - along.y() * across.x();
  return (side == Side::right) != backward ? to_the_left : -to_the_left;
}

std::vector<Bridge> find_bridges(std::span<const data::GaitEvent> events) {
  const auto times = times_of(events);
  std::vector<double> durations;
  std::vector<Bridge> out;
  for (const Side side : data::kBothSides) {
    const auto& strikes = times[data::index_of(side)][data::index_of(FootEvent::strike)];
    for (std::size_t i = 0; i + 1 < strikes.size(); ++i) {
      durations.push_back(strikes[i + 1] - strikes[i]);
      out.push_back({.side = side, .start_s = strikes[i], .end_s = strikes[i + 1]});
    }
  }
  const double usual = math::median(durations);
  std::erase_if(out, [&](const Bridge& bridge) {
    const auto& offs = times[data::index_of(bridge.side)][data::index_of(FootEvent::off)];
    const auto between =
        std::ranges::count_if(offs, [&](double t) { return t > bridge.start_s && t < bridge.end_s; });
    return between < 2 && !(bridge.end_s - bridge.start_s > kMostOfMedian * usual);
  });
  for (auto& bridge : out) bridge.strides = (bridge.end_s - bridge.start_s) / usual;
  return out;
}

std::vector<Stride> find_strides(std::span<const data::GaitEvent> events) {
  const auto bridges = find_bridges(events);
  std::vector<Stride> out;
  for (const Side side : data::kBothSides) {
    std::vector<std::size_t> strikes;
    for (std::size_t i = 0; i < events.size(); ++i)
      if (events[i].side == side && events[i].what == FootEvent::strike) strikes.push_back(i);
    std::ranges::stable_sort(strikes, {}, [&](std::size_t i) { return events[i].time_s; });
    for (std::size_t k = 0; k + 1 < strikes.size(); ++k) {
      const double start_s = events[strikes[k]].time_s, duration = events[strikes[k + 1]].time_s - start_s;
      const bool bridge = std::ranges::any_of(
          bridges, [&](const Bridge& one) { return one.side == side && one.start_s == start_s; });
      if (!bridge && duration >= kLeastCycle_s && duration <= kMostCycle_s)
        out.push_back({.start = strikes[k], .end = strikes[k + 1]});
    }
  }
  return out;
}

std::vector<GaitCycle> cycles_of(const GaitPaths& paths, std::span<const data::GaitEvent> events,
                                 std::span<const Stride> strides, const Eigen::RowVector2d& ground,
                                 bool backward) {
  const auto times = times_of(events);
  std::vector<GaitCycle> out;
  for (const auto& stride : strides)
    if (const double start_s = events[stride.start].time_s, end_s = events[stride.end].time_s;
        start_s < end_s)
      out.push_back(
          {.side = events[stride.start].side, .start_s = start_s, .end_s = end_s, .backward = backward});
  for (auto& cycle : out) {
    const Side other = data::opposite(cycle.side);
    const auto& own = times[data::index_of(cycle.side)];
    const auto& others = times[data::index_of(other)];
    const auto strike = data::index_of(FootEvent::strike), off = data::index_of(FootEvent::off);
    const double duration = cycle.end_s - cycle.start_s;
    cycle.off_s = first_between(own[off], cycle.start_s, cycle.end_s);
    cycle.other_strike_s = first_between(others[strike], cycle.start_s, cycle.end_s);
    cycle.other_off_s = first_between(
        others[off], cycle.start_s, std::isfinite(cycle.other_strike_s) ? cycle.other_strike_s : cycle.end_s);
    const auto print = [&](Side side, double strike_s) {
      return print_of(paths, paths.foot(side), strike_s, stance_of(times, side, strike_s, duration), ground);
    };
    cycle.print = print(cycle.side, cycle.start_s);
    cycle.next_print = print(cycle.side, cycle.end_s);
    cycle.other_print = print(other, cycle.other_strike_s);
  }
  return out;
}

std::vector<GaitCycle> find_cycles(const GaitPaths& paths, std::span<const data::GaitEvent> events,
                                   const Eigen::RowVector2d& ground, bool backward) {
  return cycles_of(paths, events, find_strides(events), ground, backward);
}

}  // namespace kinemark::analysis
