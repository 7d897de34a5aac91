// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/around/around.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"

namespace kinemark::workflow {
namespace {

constexpr std::string_view kUnits = "units", kOneUnit = "unit:", kMovement = "movement";
constexpr std::size_t kNamesShown = 8;

/// "; did you mean 'A' or 'B'?" where something is near, else what there is.
std::string instead(std::string_view word, const std::vector<std::string>& names, std::string_view of) {
  const auto near = nearest_names(word, names);
  if (!near.empty()) return fmt::format("nearest: {}", join(near));
  return names.empty() ? fmt::format("there are no {}", of)
                       : fmt::format("there are {}", join_names(names, kNamesShown));
}

std::vector<std::string> ids_of(const data::Neural& neural) {
  std::vector<std::string> out;
  for (const auto& unit : neural.units) out.push_back(unit.id);
  return out;
}

/// Spikes of the units that `what` names.
Result<std::vector<NamedEvents>> spikes_of(const data::Neural& neural, const std::string& what) {
  std::vector<NamedEvents> out;
  if (what == kUnits) {
    for (const auto& unit : neural.units)
      out.push_back({.name = fmt::format("unit {}", unit.id), .times_s = unit.times_s});
    return out;
  }
  const std::string id = what.substr(kOneUnit.size());
  const auto* unit = neural.find_unit(id);
  if (unit == nullptr)
    return fail(Code::usage,
                fmt::format("there is no unit '{}'; {}", id, instead(id, ids_of(neural), "units")));
  out.push_back({.name = fmt::format("unit {}", id), .times_s = unit->times_s});
  return out;
}

/// Starts of a table's intervals, for each value of a column apart where one is named.
Result<std::vector<NamedEvents>> starts_of(const data::IntervalTable& table, const std::string& column) {
  std::vector<NamedEvents> out;
  const auto add = [&out](const std::string& name, double time_s) {
    auto at = std::ranges::find(out, name, &NamedEvents::name);
    if (at == out.end()) at = out.insert(out.end(), {.name = name, .times_s = {}});
    at->times_s.push_back(time_s);
  };
  for (const auto& row : table.rows) {
    if (std::isnan(row.start_s)) continue;
    if (column.empty()) {
      add(table.name, row.start_s);
      continue;
    }
    const auto label = std::ranges::find(row.labels, column, &data::LabelledValue::column);
    if (label == row.labels.end()) {
      std::vector<std::string> names;
      for (const auto& one : row.labels) names.push_back(one.column);
      return fail(Code::usage, fmt::format("{} have no column '{}'; {}", table.name, column,
                                           instead(column, names, "columns")));
    }
    add(fmt::format("{} {}={}", table.name, column, label->value), row.start_s);
  }
  return out;
}

/// Events of the recording with this label, each context apart.
std::vector<NamedEvents> labelled(const std::vector<data::Event>& events, const std::string& label) {
  std::vector<NamedEvents> out;
  for (const auto& event : events) {
    if (event.label != label) continue;
    const std::string name = event.context.empty() ? label : fmt::format("{} {}", event.context, label);
    auto at = std::ranges::find(out, name, &NamedEvents::name);
    if (at == out.end()) at = out.insert(out.end(), {.name = name, .times_s = {}});
    at->times_s.push_back(event.time_s);
  }
  return out;
}

/// Everything that --around can name here.
std::vector<std::string> known_words(const MovementSession& session, const data::Neural& neural) {
  std::vector<std::string> out{std::string(kUnits), std::string(kMovement)};
  for (const auto& table : neural.intervals) out.push_back(table.name);
  for (const auto& event : session.events)
    if (std::ranges::find(out, event.label) == out.end()) out.push_back(event.label);
  return out;
}

/// The events that are no spikes.
Result<std::vector<NamedEvents>> events_of(const MovementSession& session, const data::Neural& neural,
                                           const std::string& what) {
  if (what == kMovement) {
    if (session.movements.empty())
      return fail(Code::bad_input,
                  "no movement starts in the recording, around which spikes could be counted");
    return session.movements;
  }
  const auto colon = what.find(':');
  if (const auto* table = neural.find_intervals(what.substr(0, colon)); table != nullptr)
    return starts_of(*table, colon == std::string::npos ? "" : what.substr(colon + 1));
  auto out = labelled(session.events, what);
  if (!out.empty()) return out;
  return fail(Code::usage, fmt::format("--around '{}': nothing is called so; {}", what,
                                       instead(what, known_words(session, neural), "events")));
}

bool is_spikes(const std::string& what) { return what == kUnits || what.starts_with(kOneUnit); }

/// Spikes and intervals on the recording's clock.
void shift(data::Neural& neural, double offset_s) {
  for (auto& unit : neural.units)
    for (double& time : unit.times_s) time += offset_s;
  for (auto& table : neural.intervals)
    for (auto& row : table.rows) {
      row.start_s += offset_s;
      row.stop_s += offset_s;
    }
}

/// Whether spikes lie within the recording: none is a failure, some outside are a warning.
Status check_clock(const data::Neural& neural, const analysis::ObservedSpan& span,
                   std::vector<std::string>& warnings) {
  std::int64_t inside = 0, all = 0;
  double first = kNaN, last = kNaN;
  for (const auto& unit : neural.units)
    for (const double time : unit.times_s) {
      ++all;
      inside += time >= span.start_s && time <= span.end_s ? 1 : 0;
      first = time < first || all == 1 ? time : first;
      last = time > last || all == 1 ? time : last;
    }
  if (all == 0) return fail(Code::bad_input, "no unit has a spike");
  if (inside == 0)
    return fail(
        Code::bad_input,
        fmt::format("all {} lie outside the recording: they go from {:.3f} to {:.3f} s, the recording "
                    "from {:.3f} to {:.3f} s; of two clocks, --clock-offset S brings spikes onto the "
                    "recording's",
                    counted(all, "spike"), first, last, span.start_s, span.end_s));
  if (inside < all)
    warnings.push_back(
        fmt::format("{} of {} lie outside the recording ({:.3f} to {:.3f} s) and have no "
                    "movement",
                    all - inside, counted(all, "spike"), span.start_s, span.end_s));
  return {};
}

/// Events whose window leaves the recording, one sentence for all.
void note_outside(const std::vector<analysis::AroundCurve>& curves, std::vector<std::string>& warnings) {
  std::vector<std::string> names;
  std::int64_t outside = 0, all = 0;
  for (const auto& curve : curves) {
    if (std::ranges::find(names, curve.events) != names.end()) continue;
    names.push_back(curve.events);
    outside += curve.outside;
    all += curve.outside + curve.used;
  }
  if (outside > 0)
    warnings.push_back(fmt::format("{} of {} are left out: their window leaves the recording", outside,
                                   counted(all, "event")));
}

}  // namespace

bool wants_movements(const AroundChoice& choice) { return choice.what == kMovement; }

Result<AroundFound> around(const MovementSession& session, data::Neural neural, const AroundChoice& choice) {
  if (auto s = choice.check(); !s) return std::unexpected(s.error());
  if (neural.units.empty())
    return fail(Code::bad_input,
                "there are no units with spikes; --spikes FILE.nwb names a file that has them");
  shift(neural, choice.clock_offset_s);
  AroundFound out;
  const bool spikes = is_spikes(choice.what);
  const auto events = spikes ? spikes_of(neural, choice.what) : events_of(session, neural, choice.what);
  if (!events) return std::unexpected(events.error());
  if (auto s = check_clock(neural, session.span, out.remarks.warnings); !s) return std::unexpected(s.error());
  for (const auto& [name, times_s] : *events) {
    if (spikes)
      for (const auto& curve : session.curves)
        out.curves.push_back(analysis::mean_around(name, times_s, curve, session.span, choice));
    else
      for (const auto& unit : neural.units)
        out.curves.push_back(
            analysis::rate_around(name, times_s, unit.id, unit.times_s, session.span, choice));
  }
  if (std::ranges::all_of(out.curves, [](const auto& curve) { return curve.used == 0; }))
    return fail(Code::bad_input,
                fmt::format("no event of '{}' has its whole window in the recording, which lasts "
                            "from {:.3f} to {:.3f} s",
                            choice.what, session.span.start_s, session.span.end_s));
  note_outside(out.curves, out.remarks.warnings);
  return out;
}

}  // namespace kinemark::workflow
