// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/event_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kinemark/pipeline/files/table_cell.h"

namespace kinemark::pipeline {
namespace {

std::string_view method_of(analysis::PathEventKind kind) {
  return kind == analysis::PathEventKind::cycle_start ? "upward crossing of the mean"
                                                      : "5 % of the peak speed";
}

bool is_of_feet(const EventRow& event) { return event.subject.empty(); }

bool is_of_feet(const data::Event& event, TimeBase time) {
  time.t0_s = event.time_s, time.frames = 1;
  return !analysis::events_of_file(std::vector{event}, time).events.empty();
}

}  // namespace

std::vector<EventRow> events_of(const analysis::Gait& gait, const TimeBase& time) {
  std::vector<EventRow> out;
  for (const auto& event : gait.events)
    out.push_back({.subject = {},
                   .context = std::string(data::to_string(event.side)),
                   .region = {},
                   .label = std::string(data::to_string(event.what)),
                   .time_s = event.time_s,
                   .frame = time.number(time.nearest_frame(event.time_s)),
                   .sd_s = event.sd_s,
                   .source = std::string(data::to_string(event.source)),
                   .method = event.method});
  return out;
}

std::vector<EventRow> events_of(const std::vector<analysis::PathRhythm>& rhythms, const TimeBase& time) {
  std::vector<EventRow> out;
  for (const auto& rhythm : rhythms)
    for (const auto& event : rhythm.events)
      out.push_back({.subject = rhythm.subject,
                     .context = {},
                     .region = rhythm.region,
                     .label = std::string(analysis::to_string(event.kind)),
                     .time_s = event.time_s,
                     .frame = time.number(time.nearest_frame(event.time_s)),
                     .sd_s = event.sd_s,
                     .source = std::string(data::to_string(data::EventSource::kinematics)),
                     .method = std::string(method_of(event.kind))});
  return out;
}

std::string events_csv_columns(const RecordingName& recording) {
  return name_columns() + ",subject,context,region,label,time_s,frame,sd_s,source,method" +
         more_columns(recording) + "\n";
}

std::string events_csv_rows(const std::vector<EventRow>& events, const RecordingName& recording) {
  const auto first = name_cells(recording), last = more_cells(recording);
  std::string out;
  for (const auto& event : events)
    out += fmt::format("{},{},{},{},{},{:.6f},{},{},{},{}{}\n", first, table_cell(event.subject),
                       event.context, table_cell(event.region), table_cell(event.label), event.time_s,
                       event.frame, std::isfinite(event.sd_s) ? fmt::format("{:.6f}", event.sd_s) : "",
                       event.source, table_cell(event.method), last);
  return out;
}

std::string events_csv(const std::vector<EventRow>& events, const RecordingName& recording) {
  return events_csv_columns(recording) + events_csv_rows(events, recording);
}

data::Trial with_events(data::Trial trial, const std::vector<EventRow>& events) {
  const bool of_feet = std::ranges::any_of(events, [](const EventRow& event) { return is_of_feet(event); });
  std::erase_if(trial.events, [&](const data::Event& old) {
    return (of_feet && is_of_feet(old, trial.markers.time)) ||
           std::ranges::any_of(
               events, [&](const EventRow& event) { return !is_of_feet(event) && event.label == old.label; });
  });
  for (const auto& event : events)
    trial.events.push_back({.label = event.label,
                            .context = event.context.empty() ? "General" : event.context,
                            .time_s = event.time_s});
  std::ranges::stable_sort(trial.events, {}, &data::Event::time_s);
  return trial;
}

nlohmann::ordered_json rhythms_json(const std::vector<analysis::PathRhythm>& rhythms) {
  auto out = nlohmann::ordered_json::array();
  for (const auto& rhythm : rhythms) {
    nlohmann::ordered_json one{{"subject", rhythm.subject}};
    if (!rhythm.region.empty()) one["region"] = rhythm.region;
    one["periodic"] = rhythm.periodic;
    one["period_s"] = json_number(rhythm.period_s);
    one["verdict"] = rhythm.verdict;
    one["events"] = nlohmann::ordered_json::array();
    for (const auto& event : rhythm.events)
      one["events"].push_back({{"label", analysis::to_string(event.kind)},
                               {"time_s", event.time_s},
                               {"sd_s", json_number(event.sd_s)}});
    out.push_back(std::move(one));
  }
  return out;
}

std::string rhythms_text(const std::vector<analysis::PathRhythm>& rhythms) {
  std::string out;
  for (const auto& rhythm : rhythms) {
    out += fmt::format("{}{}: {}\n", rhythm.subject, rhythm.region.empty() ? "" : ", " + rhythm.region,
                       rhythm.verdict);
    for (const auto& event : rhythm.events)
      out += fmt::format(
          "  {:<15} {:9.4f} {} s\n", analysis::to_string(event.kind), event.time_s,
          std::isfinite(event.sd_s) ? fmt::format("+- {:.4f}", event.sd_s) : std::string("         "));
  }
  return out;
}

}  // namespace kinemark::pipeline
