// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_events.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "kinemark/core/enum_names.h"
#include "kinemark/core/index.h"

namespace kinemark::analysis {
namespace {

using data::EventSource;
using data::FootEvent;
using data::GaitEvent;
using data::Side;

constexpr EnumNames<EventChoice::file> kChoices{"best", "plates", "kinematics", "file"};
constexpr double kSame_s = 0.1;  // between two sources' times of one instant
constexpr double kEventSd_s = 0.006;
constexpr double kFreedom = 6.0;  // of kEventSd_s as a variance known before

// SD of a method's common offset to plates: for strike, for leaving (docs/theory/gait.md).
double offset_sd_s(EventMethod method, FootEvent what) {
  const bool strike = what == FootEvent::strike;
  switch (method) {
    case EventMethod::foot_velocity:
      return strike ? 0.008 : 0.018;
    case EventMethod::coordinates:
      return strike ? 0.045 : 0.012;
    case EventMethod::speed_threshold:
      break;
  }
  return strike ? 0.018 : 0.035;
}

// Without plates, the first that finds anything.
constexpr std::array<std::array<EventMethod, 3>, 2> kPreferred{
    {{EventMethod::foot_velocity, EventMethod::speed_threshold, EventMethod::coordinates},
     {EventMethod::coordinates, EventMethod::foot_velocity, EventMethod::speed_threshold}}};

// What one method tells of one kind: seconds for each window of each side; NaN where nothing.
using ByWindow = std::array<std::vector<double>, 2>;

std::optional<double> nearest_to(const std::vector<double>& times, double time_s) {
  std::optional<double> best;
  for (const double t : times)
    if (std::abs(t - time_s) < (best ? std::abs(*best - time_s) : kSame_s)) best = t;
  return best;
}

double mean_of(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

double squares_about(const std::vector<double>& x, double centre) {
  double sum = 0.0;
  for (const double value : x) sum += (value - centre) * (value - centre);
  return sum;
}

// Log likelihood of differences with a common offset and errors of each.
double likelihood(const std::vector<double>& differences, double offset_sd, double event_sd) {
  const auto n = static_cast<double>(differences.size());
  const double mean = mean_of(differences), each = event_sd * event_sd,
               total = each + n * offset_sd * offset_sd;
  return -0.5 * (squares_about(differences, mean) / each + n * mean * mean / total +
                 (n - 1.0) * std::log(each) + std::log(total));
}

Agreement agreement_of(std::string what, const std::vector<double>& differences) {
  Agreement out{
      .what = std::move(what), .count = static_cast<int>(differences.size()), .mean_s = mean_of(differences)};
  for (const double d : differences) out.most_s = std::max(out.most_s, std::abs(d));
  if (differences.size() > 1)
    out.sd_s =
        std::sqrt(squares_about(differences, out.mean_s) / static_cast<double>(differences.size() - 1));
  return out;
}

// Differences of a method from events of plates or of a file.
std::vector<double> differences_to(const ByWindow& found, std::span<const GaitEvent> events, FootEvent what) {
  std::vector<double> out;
  for (const auto& event : events)
    if (event.what == what)
      if (const auto t = nearest_to(found[data::index_of(event.side)], event.time_s))
        out.push_back(*t - event.time_s);
  return out;
}

std::vector<double> differences_between(const ByWindow& a, const ByWindow& b) {
  std::vector<double> out;
  for (std::size_t side = 0; side < 2; ++side)
    for (std::size_t i = 0; i < a[side].size(); ++i)
      if (const double d = a[side][i] - b[side][i]; std::isfinite(d)) out.push_back(d);
  return out;
}

std::size_t found_by(const ByWindow& times) {
  std::size_t count = 0;
  for (const auto& side : times)
    count += static_cast<std::size_t>(std::ranges::count_if(side, [](double t) { return std::isfinite(t); }));
  return count;
}

class Finder {
 public:
  Finder(const GaitPaths& paths, std::span<const GaitEvent> of_plates, EventsFound& out)
      : paths_(paths), plates_(of_plates), out_(out) {}

  void find(FootEvent what) {
    std::array<ByWindow, kEventMethods.size()> by_method;
    for (const auto method : kEventMethods) by_method[at(static_cast<int>(method))] = times_of(what, method);
    const auto& order = kPreferred[data::index_of(what)];
    auto& chosen = out_.chosen[data::index_of(what)];
    chosen.method = order.front();
    for (const auto method : order)
      if (found_by(by_method[at(static_cast<int>(method))]) > 0) {
        chosen.method = method;
        break;
      }
    choose_by_plates(what, by_method, chosen);
    const auto& times = by_method[at(static_cast<int>(chosen.method))];
    chosen.error = error_of(what, by_method, chosen);
    for (const auto method : order)
      if (method != chosen.method)
        if (const auto d = differences_between(by_method[at(static_cast<int>(method))], times); !d.empty())
          out_.agreement.push_back(agreement_of(
              fmt::format("{}: {} and {}", to_string(what), to_string(method), to_string(chosen.method)), d));
    add(what, chosen, times);
  }

 private:
  ByWindow times_of(FootEvent what, EventMethod method) const {
    ByWindow out;
    for (const Side side : data::kBothSides) {
      out[data::index_of(side)] = find_in_windows(paths_, side, what, method,
                                                  out_.swings[data::index_of(side)], out_.ground.velocity);
      for (double& t : out[data::index_of(side)]) t = paths_.time_s(t);
    }
    return out;
  }

  void choose_by_plates(FootEvent what, const std::array<ByWindow, kEventMethods.size()>& by_method,
                        KinematicChoice& chosen) const {
    double best = -1e300;
    for (const auto method : kPreferred[data::index_of(what)]) {
      const auto d = differences_to(by_method[at(static_cast<int>(method))], plates_, what);
      if (d.empty() || static_cast<int>(d.size()) < chosen.compared) continue;
      const double value = likelihood(d, offset_sd_s(method, what), kEventSd_s);
      if (static_cast<int>(d.size()) > chosen.compared || value > best) {
        best = value;
        chosen.method = method;
        chosen.compared = static_cast<int>(d.size());
      }
    }
  }

  MethodError error_of(FootEvent what, const std::array<ByWindow, kEventMethods.size()>& by_method,
                       const KinematicChoice& chosen) {
    const auto& times = by_method[at(static_cast<int>(chosen.method))];
    MethodError out{.offset_sd_s = offset_sd_s(chosen.method, what), .event_sd_s = kEventSd_s};
    const double before = kFreedom * kEventSd_s * kEventSd_s;
    if (chosen.compared > 0) {
      const auto d = differences_to(times, plates_, what);
      out_.agreement.push_back(
          agreement_of(fmt::format("{}: {} and the plates", to_string(what), to_string(chosen.method)), d));
      const auto n = static_cast<double>(d.size());
      const double precision = n / (kEventSd_s * kEventSd_s) + 1.0 / (out.offset_sd_s * out.offset_sd_s);
      out.offset_s = n * mean_of(d) / (kEventSd_s * kEventSd_s) / precision;
      out.event_sd_s = std::sqrt((before + squares_about(d, mean_of(d))) / (kFreedom + n - 1.0));
      out.offset_sd_s = std::sqrt(1.0 / precision);
      return out;
    }
    for (const auto method : kPreferred[data::index_of(what)]) {
      if (method == chosen.method) continue;
      const auto d = differences_between(by_method[at(static_cast<int>(method))], times);
      if (d.size() < 2) continue;
      // Half of what differs between two methods is taken as either's.
      out.event_sd_s = std::sqrt((before + 0.5 * squares_about(d, mean_of(d))) /
                                 (kFreedom + static_cast<double>(d.size()) - 1.0));
      out.offset_sd_s = std::max(out.offset_sd_s, 0.5 * std::abs(mean_of(d)));
      break;
    }
    return out;
  }

  void add(FootEvent what, const KinematicChoice& chosen, const ByWindow& times) {
    for (const Side side : data::kBothSides)
      for (std::size_t i = 0; i < times[data::index_of(side)].size(); ++i) {
        const double t = times[data::index_of(side)][i];
        if (!std::isfinite(t)) continue;
        out_.events.push_back({.side = side,
                               .what = what,
                               .time_s = t - chosen.error.offset_s,
                               .sd_s = std::hypot(chosen.error.offset_sd_s, chosen.error.event_sd_s),
                               .source = EventSource::kinematics,
                               .method = std::string(to_string(chosen.method))});
        out_.window.push_back(static_cast<std::int64_t>(i));
      }
  }

  const GaitPaths& paths_;
  std::span<const GaitEvent> plates_;
  EventsFound& out_;
};

// An event of a better source takes the place of the nearest of its kind and side, or comes beside.
void put(EventsFound& found, const GaitEvent& event) {
  std::size_t best = found.events.size();
  for (std::size_t i = 0; i < found.events.size(); ++i) {
    const auto& there = found.events[i];
    if (there.side != event.side || there.what != event.what) continue;
    const double limit =
        best < found.events.size() ? std::abs(found.events[best].time_s - event.time_s) : kSame_s;
    if (std::abs(there.time_s - event.time_s) < limit) best = i;
  }
  if (best == found.events.size()) {
    found.events.push_back(event);
    found.window.push_back(-1);
  } else {
    found.events[best] = event;
    found.window[best] = -1;
  }
}

void sort_by_time(EventsFound& found) {
  std::vector<std::size_t> order(found.events.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return found.events[i].time_s; });
  std::vector<GaitEvent> events;
  std::vector<std::int64_t> window;
  for (const auto i : order) {
    events.push_back(std::move(found.events[i]));
    window.push_back(found.window[i]);
  }
  found.events = std::move(events);
  found.window = std::move(window);
}

void compare_with_file(EventsFound& found, std::span<const GaitEvent> of_file) {
  for (const FootEvent what : data::kFootEvents) {
    ByWindow times;
    for (const auto& event : found.events)
      if (event.what == what) times[data::index_of(event.side)].push_back(event.time_s);
    if (const auto d = differences_to(times, of_file, what); !d.empty())
      found.agreement.push_back(agreement_of(fmt::format("{}: these and the file's", to_string(what)), d));
  }
}

}  // namespace

std::string_view to_string(EventChoice choice) { return kChoices[choice]; }

Result<EventChoice> parse_event_choice(std::string_view name) {
  return kChoices.parse(name, "choice of events");
}

EventsFound find_gait_events(const GaitPaths& paths, std::span<const GaitEvent> of_plates,
                             std::span<const GaitEvent> of_file, EventChoice choice) {
  EventsFound out;
  for (const Side side : data::kBothSides) out.swings[data::index_of(side)] = find_swings(paths, side);
  out.ground = ground_velocity(paths, out.swings);
  Finder finder(paths, of_plates, out);
  for (const FootEvent what : data::kFootEvents) finder.find(what);
  if (choice == EventChoice::plates || choice == EventChoice::file) out.events.clear(), out.window.clear();
  if (choice == EventChoice::best || choice == EventChoice::plates)
    for (const auto& event : of_plates) put(out, event);
  if (choice != EventChoice::file) compare_with_file(out, of_file);
  if (choice == EventChoice::file || (choice == EventChoice::best && out.events.empty()))
    for (const auto& event : of_file) put(out, event);
  sort_by_time(out);
  return out;
}

std::string sentence_of(const Agreement& agreement) {
  const double mean = 1e3 * agreement.mean_s;
  if (agreement.count == 1) return fmt::format("{} differ by {:.0f} ms in one event", agreement.what, mean);
  return fmt::format("{} differ by {:.0f} +- {:.0f} ms in {} events, by {:.0f} ms at most", agreement.what,
                     mean, 1e3 * agreement.sd_s, agreement.count, 1e3 * agreement.most_s);
}

}  // namespace kinemark::analysis
