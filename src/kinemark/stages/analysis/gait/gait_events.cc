// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_events.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "kinemark/core/enum_names.h"
#include "kinemark/stages/analysis/gait/event_labels.h"
#include "kinemark/stages/analysis/gait/marker_events.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::GaitEvent;

constexpr EnumNames<EventChoice::file> kChoices{"best", "plates", "kinematics", "file"};
constexpr double kSame_s = 0.15;  // between two sources' times of one instant
constexpr double kOutOfStep_s = 0.03;
constexpr std::int64_t kNoEdge = -1;
constexpr double kUsualCount = 2.0;  // differences that a laboratory's usual scatter is worth

double square(double x) { return x * x; }

double mean_of(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

Agreement agreement_of(std::string what, const std::vector<double>& differences) {
  Agreement out{
      .what = std::move(what), .count = static_cast<int>(differences.size()), .mean_s = mean_of(differences)};
  double squares = 0.0;
  for (const double d : differences) {
    out.most_s = std::max(out.most_s, std::abs(d));
    squares += (d - out.mean_s) * (d - out.mean_s);
  }
  if (differences.size() > 1) out.sd_s = std::sqrt(squares / static_cast<double>(differences.size() - 1));
  return out;
}

// Of events of one kind: the nearest of the same side, within kSame_s; events.size() of none.
std::size_t nearest_to(std::span<const GaitEvent> events, const GaitEvent& event) {
  std::size_t best = events.size();
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events[i].side != event.side || events[i].what != event.what) continue;
    const double limit = best < events.size() ? std::abs(events[best].time_s - event.time_s) : kSame_s;
    if (std::abs(events[i].time_s - event.time_s) < limit) best = i;
  }
  return best;
}

// Differences of events of one kind from those of another source.
std::vector<double> differences(std::span<const GaitEvent> of, std::span<const GaitEvent> from,
                                FootEvent what) {
  std::vector<double> out;
  for (const auto& event : from)
    if (event.what == what)
      if (const auto i = nearest_to(of, event); i < of.size()) out.push_back(of[i].time_s - event.time_s);
  return out;
}

void compare(std::span<const GaitEvent> ours, std::string_view our_name, std::span<const GaitEvent> theirs,
             std::string_view their_name, std::vector<Agreement>& out) {
  for (const FootEvent what : data::kFootEvents)
    if (const auto d = differences(ours, theirs, what); !d.empty())
      out.push_back(agreement_of(fmt::format("{}: {} and {}", to_string(what), our_name, their_name), d));
}

// Both kinds displaced the same way by more than 30 ms: no threshold or filter of the force does that.
void judge_clocks(const MarkerEvents& of_markers, std::span<const GaitEvent> of_plates, EventsFound& out) {
  std::array<double, 2> later{};  // markers after plates
  for (const FootEvent what : data::kFootEvents) {
    const auto d = differences(of_markers.events, of_plates, what);
    if (d.empty()) return;
    later[data::index_of(what)] = mean_of(d);
  }
  if (!(std::min(std::abs(later[0]), std::abs(later[1])) > kOutOfStep_s) ||
      (later[0] > 0.0) != (later[1] > 0.0))
    return;
  out.out_of_step = true;
  out.notes.push_back(fmt::format(
      "plates and markers are out of step: the plates' strikes come {:.0f} ms and their foot offs "
      "{:.0f} ms {} those of "
      "the markers; forces of this recording belong to other frames",
      1e3 * std::abs(later[0]), 1e3 * std::abs(later[1]), later[0] > 0.0 ? "before" : "after"));
}

// What the plates tell of the markers' offset: normal with the common SD before, events' own errors about it.
PlateOffset offset_of(const MarkerEvents& of_markers, std::span<const GaitEvent> of_plates, FootEvent what) {
  PlateOffset out;
  double precision = 0.0, weighted = 0.0, before = 0.0;
  for (const auto& event : of_plates) {
    if (event.what != what) continue;
    const auto i = nearest_to(of_markers.events, event);
    if (i == of_markers.events.size()) continue;
    const auto& fused = of_markers.fused[i];
    const double plate = std::isfinite(event.sd_s) ? event.sd_s : 0.0;
    const double weight = 1.0 / (square(fused.error.own_s) + square(fused.error.foot_s) + square(plate));
    precision += weight;
    weighted += weight * (of_markers.events[i].time_s - event.time_s);
    before += square(fused.error.kind_s);
    ++out.compared;
  }
  if (out.compared == 0) return out;
  before /= out.compared;
  out.offset_s = weighted / (precision + 1.0 / before);
  out.share = std::sqrt(1.0 / (1.0 + before * precision));
  return out;
}

void take_markers(const MarkerEvents& of_markers, EventsFound& out) {
  out.events = of_markers.events;
  for (std::size_t i = 0; i < out.events.size(); ++i) {
    const auto& offset = out.offset[data::index_of(out.events[i].what)];
    out.edge.push_back(static_cast<std::int64_t>(i));
    out.error.push_back(of_markers.fused[i].error);
    out.error[i].kind_s *= offset.share;
    out.events[i].time_s -= offset.offset_s;
    out.events[i].sd_s = out.error[i].sd_s();
  }
}

// An event of a better source takes the place of the nearest of its kind and side, or comes beside.
void put(EventsFound& found, const GaitEvent& event, const data::EventError& error) {
  const auto i = nearest_to(found.events, event);
  if (i == found.events.size()) {
    found.events.push_back(event);
    found.edge.push_back(kNoEdge);
    found.error.push_back(error);
  } else {
    found.events[i] = event;
    found.edge[i] = kNoEdge;
    found.error[i] = error;
  }
  found.events[std::min(i, found.events.size() - 1)].sd_s = error.sd_s();
}

// Differences of the file's events of one kind from those of a source, and what that errs by: variances.
struct AgainstFile {
  std::vector<double> later;  // file after source
  double kind = 0.0, own = 0.0;
};

// What the file's events of a kind err by: their offset is normal with a laboratory's usual SD before,
// sources tell it with their own offsets. Times stay, so that the offset itself is an error.
data::EventError error_of_file(double usual_own_s, std::span<const AgainstFile> sources) {
  double squares = kUsualCount * square(usual_own_s), count = kUsualCount;
  for (const auto& source : sources) {
    if (source.later.empty()) continue;
    const double mean = mean_of(source.later), more = static_cast<double>(source.later.size()) - 1.0;
    double about = 0.0;
    for (const double d : source.later) about += square(d - mean);
    squares += std::max(0.0, about - more * source.own), count += more;
  }
  const double own = squares / count;
  double precision = 1.0 / square(kFileOffset_s), weighted = 0.0, remains = precision;
  for (const auto& source : sources) {
    if (source.later.empty()) continue;
    const double variance = source.kind + (own + source.own) / static_cast<double>(source.later.size());
    precision += 1.0 / variance, weighted += mean_of(source.later) / variance;
    if (!(source.kind > 0.0)) remains += 1.0 / variance;  // labels by markers err as markers do
  }
  return {.kind_s = std::hypot(weighted / precision, std::sqrt(1.0 / remains)), .own_s = std::sqrt(own)};
}

// The file's events with what they err by, as plates in step and markers of a gait show.
void put_file(const MarkerEvents& of_markers, std::span<const GaitEvent> of_plates,
              std::span<const GaitEvent> of_file, EventsFound& out) {
  for (const FootEvent what : data::kFootEvents) {
    AgainstFile plates, markers;
    double usual_own_s = kFileOwn_s;
    bool any = false;
    for (const auto& event : of_file) {
      if (event.what != what) continue;
      any = true;
      if (event.sd_s > kFileOffset_s) usual_own_s = std::sqrt(square(event.sd_s) - square(kFileOffset_s));
      if (const auto i = nearest_to(of_plates, event); i < of_plates.size() && !out.out_of_step) {
        plates.later.push_back(event.time_s - of_plates[i].time_s);
        plates.own += std::isfinite(of_plates[i].sd_s) ? square(of_plates[i].sd_s) : 0.0;
      }
      if (const auto i = nearest_to(of_markers.events, event);
          i < of_markers.events.size() && of_markers.kind.not_gait.empty()) {
        const auto& error = of_markers.fused[i].error;
        markers.later.push_back(event.time_s - of_markers.events[i].time_s);
        markers.kind += square(error.kind_s), markers.own += square(error.foot_s) + square(error.own_s);
      }
    }
    if (!any) continue;
    std::string by;
    for (const auto& [source, name] : {std::pair{&plates, "plates"}, std::pair{&markers, "markers"}}) {
      if (source->later.empty()) continue;
      const auto n = static_cast<double>(source->later.size());
      source->kind /= n, source->own /= n;
      by += fmt::format("{}{} of {}", by.empty() ? "" : " and ", source->later.size(), name);
    }
    const auto error = error_of_file(usual_own_s, std::array{plates, markers});
    for (const auto& event : of_file)
      if (event.what == what) put(out, event, error);
    out.notes.push_back(
        fmt::format("{}: the file's events err by {:.0f} ms (SD), as {}", to_string(what), 1e3 * error.sd_s(),
                    by.empty() ? "a laboratory's usually do: nothing else tells of them" : by + " show"));
  }
}

void sort_by_time(EventsFound& found) {
  std::vector<std::size_t> order(found.events.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return found.events[i].time_s; });
  std::vector<GaitEvent> events;
  std::vector<std::int64_t> edge;
  std::vector<data::EventError> error;
  for (const auto i : order) {
    events.push_back(std::move(found.events[i]));
    edge.push_back(found.edge[i]);
    error.push_back(found.error[i]);
  }
  found.events = std::move(events);
  found.edge = std::move(edge);
  found.error = std::move(error);
}

}  // namespace

std::string_view to_string(EventChoice choice) { return kChoices[choice]; }

Result<EventChoice> parse_event_choice(std::string_view name) {
  return kChoices.parse(name, "choice of events");
}

EventsFound find_gait_events(const MarkerEvents& of_markers, std::span<const GaitEvent> of_plates,
                             std::span<const GaitEvent> of_file, EventChoice choice) {
  EventsFound out;
  judge_clocks(of_markers, of_plates, out);
  compare(of_markers.events, "markers", of_plates, "the plates", out.agreement);
  compare(of_markers.events, "markers", of_file, "the file's", out.agreement);
  compare(of_plates, "the plates", of_file, "the file's", out.agreement);
  const bool best = choice == EventChoice::best;
  if (best && !out.out_of_step)
    for (const FootEvent what : data::kFootEvents) {
      auto& offset = out.offset[data::index_of(what)];
      offset = offset_of(of_markers, of_plates, what);
      if (offset.compared > 0)
        out.notes.push_back(
            fmt::format("{}: {:.0f} ms were taken off the events of markers, as {} of plates show",
                        to_string(what), 1e3 * offset.offset_s, offset.compared));
    }
  if (best || choice == EventChoice::kinematics) take_markers(of_markers, out);
  if ((best && !out.out_of_step) || choice == EventChoice::plates)
    for (const auto& event : of_plates)
      put(out, event, {.own_s = std::isfinite(event.sd_s) ? event.sd_s : 0.0});
  if (best && out.out_of_step)
    out.notes.emplace_back("events are those of the markers, as plates are out of step");
  if (choice == EventChoice::file || (best && out.events.empty()))
    put_file(of_markers, of_plates, of_file, out);
  std::ranges::move(contradicted_labels(of_markers, of_file), std::back_inserter(out.notes));
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
