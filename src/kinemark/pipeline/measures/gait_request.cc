// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/gait_request.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kinemark/io/c3d/plate_forces.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/settings_file.h"
#include "kinemark/pipeline/files/table_cell.h"

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

// Lines like left_heel = "LHEE".
Result<std::vector<analysis::MarkerRole>> read_roles(const std::filesystem::path& path) {
  const auto settings = read_settings(path);
  if (!settings) return std::unexpected(settings.error());
  std::vector<analysis::MarkerRole> out;
  for (const auto& [role, values, is_switch, on, line] : settings->list) {
    if (values.size() != 1)
      return fail(Code::bad_input, fmt::format("{}, line {}: {} is not one marker; need left_heel = \"LHEE\"",
                                               path.string(), line, role));
    out.emplace_back(role, values.front());
  }
  return out;
}

}  // namespace

Status GaitRequest::check(bool drawn) const {
  if (const auto choice = analysis::parse_event_choice(events); !choice)
    return std::unexpected(choice.error());
  const auto ending = ending_of(write_events);
  if (!write_events.empty() && ending != ".csv" && ending != ".c3d")
    return fail(Code::usage, fmt::format("{}: events are written as .csv or .c3d", write_events.string()));
  if (!write_cycles.empty() && ending_of(write_cycles) != ".csv")
    return fail(Code::usage, fmt::format("{}: cycles are written as .csv", write_cycles.string()));
  if (!angles.empty() && write_cycles.empty() && !drawn)
    return fail(Code::usage,
                "--angles has its cycles written or drawn; need --write-cycles FILE.csv, --figures "
                "FOLDER or --report FILE.html too");
  if (!drawn && (!sheet.norms.empty() || !sheet.angle_angle.empty()))
    return fail(Code::usage, fmt::format("--{} is drawn; need --figures FOLDER or --report FILE.html too",
                                         sheet.norms.empty() ? "angle-angle" : "norm"));
  return sheet.check();
}

Result<analysis::GaitOptions> gait_options(const GaitRequest& request, bool drawn) {
  if (auto s = request.check(drawn); !s) return std::unexpected(s.error());
  analysis::GaitOptions out;
  out.choice = analysis::parse_event_choice(request.events).value();
  for (const auto& text : request.markers) {
    if (ending_of(text) == ".toml" && text.find('=') == std::string::npos) {
      auto roles = read_roles(text);
      if (!roles) return std::unexpected(roles.error());
      std::ranges::move(*roles, std::back_inserter(out.markers));
      continue;
    }
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      return fail(Code::usage, fmt::format("'{}' is not ROLE=NAME (left_heel=LHEE) and no .toml file", text));
    out.markers.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return out;
}

std::optional<data::Wrenches> plates_of(const std::filesystem::path& path, const data::Trial& trial) {
  if (trial.force_plates.empty() || ending_of(path) != ".c3d") return std::nullopt;
  auto forces = io::read_plate_forces(path, {.contact_force_n = 0.0});
  if (!forces) return std::nullopt;  // the reader of markers has told what is wrong with them
  auto& all = forces->wrenches;
  const auto& time = trial.markers.time;
  const auto skipped = all.time.nearest_frame(time.t0_s);
  if (skipped < 0 || skipped + time.frames > all.frames()) return std::nullopt;
  for (auto& wrench : all.items)
    for (auto* values : {&wrench.force, &wrench.moment, &wrench.point}) {
      values->erase(values->begin() + 3 * (skipped + time.frames), values->end());
      values->erase(values->begin(), values->begin() + 3 * skipped);
    }
  all.time = time;
  return std::move(all);
}

Result<analysis::Gait> measure_gait(const std::filesystem::path& path, const data::Trial& trial,
                                    const analysis::GaitOptions& options) {
  const auto plates = plates_of(path, trial);
  analysis::GaitEvidence evidence{
      .plates = plates ? &*plates : nullptr, .corners = {}, .events = trial.events};
  for (const auto& plate : trial.force_plates) evidence.corners.push_back(plate.corners_in_world);
  return analysis::analyze_gait(trial.markers, evidence, options);
}

std::string events_csv(const analysis::Gait& gait, const TimeBase& time, const std::string& file) {
  std::string out = "file,context,label,time_s,frame,sd_s,source,method\n";
  for (const auto& event : gait.events)
    out +=
        fmt::format("{},{},{},{:.6f},{},{},{},{}\n", table_cell(file), data::to_string(event.side),
                    data::to_string(event.what), event.time_s, time.number(time.nearest_frame(event.time_s)),
                    std::isfinite(event.sd_s) ? fmt::format("{:.6f}", event.sd_s) : "",
                    data::to_string(event.source), table_cell(event.method));
  return out;
}

data::Trial with_events(data::Trial trial, const analysis::Gait& gait) {
  std::erase_if(trial.events, [&](const data::Event& event) {
    const std::vector<data::Event> one{event};
    TimeBase all = trial.markers.time;
    all.t0_s = event.time_s, all.frames = 1;
    return !analysis::events_of_file(one, all).events.empty();
  });
  for (const auto& event : gait.events)
    trial.events.push_back({.label = std::string(data::to_string(event.what)),
                            .context = std::string(data::to_string(event.side)),
                            .time_s = event.time_s});
  std::ranges::stable_sort(trial.events, {}, &data::Event::time_s);
  return trial;
}

nlohmann::ordered_json gait_json(const analysis::Gait& gait) {
  Json out;
  out["treadmill"] = gait.treadmill;
  out["belt_speed"] = gait.treadmill ? Json(1e3 * gait.belt_speed_m_per_s) : Json(nullptr);
  out["events"] = Json::array();
  for (const auto& event : gait.events)
    out["events"].push_back({{"label", data::to_string(event.what)},
                             {"context", data::to_string(event.side)},
                             {"time_s", event.time_s},
                             {"sd_s", std::isfinite(event.sd_s) ? Json(event.sd_s) : Json(nullptr)},
                             {"source", data::to_string(event.source)},
                             {"method", event.method}});
  return out;
}

std::string events_text(const analysis::Gait& gait) {
  std::string out = "Events of walking\n";
  for (const auto& event : gait.events)
    out += fmt::format(
        "  {:<5} {:<11} {:8.3f} {} s  {}\n", data::to_string(event.side), data::to_string(event.what),
        event.time_s,
        std::isfinite(event.sd_s) ? fmt::format("+- {:.3f}", event.sd_s) : std::string("        "),
        event.method);
  return out;
}

}  // namespace kinemark::pipeline
