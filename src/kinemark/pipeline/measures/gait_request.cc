// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/gait_request.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/settings_file.h"

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

bool GaitRequest::into_recording() const {
  const auto ending = ending_of(write_events);
  return ending == ".c3d" || ending == ".nwb";
}

Status GaitRequest::check(bool drawn) const {
  if (of_movement()) {
    if (!markers.empty() || !angles.empty())
      return fail(
          Code::usage,
          "--events movement takes the markers' own movements; --gait-marker and --angles are of walking");
  } else if (const auto choice = analysis::parse_event_choice(events); !choice) {
    return fail(Code::usage, choice.error().message + ", and movement for that of the markers themselves");
  }
  if (!write_events.empty() && ending_of(write_events) != ".csv" && !into_recording())
    return fail(Code::usage,
                fmt::format("{}: events are written as .csv, .c3d or .nwb", write_events.string()));
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

Status GaitRequest::check_idle() const {
  if (auto s = check(); !s) return s;
  if (!wanted() && !of_movement()) return {};
  return fail(Code::usage,
              fmt::format("--{} is of walking, of which nothing is written or drawn; need --write-events, "
                          "--write-cycles, --figures or --report too",
                          events == "best" ? "gait-marker" : "events"));
}

std::vector<std::filesystem::path> files_of(const GaitRequest& request) {
  auto files = request.sheet.norms;
  files.insert(files.end(), request.markers.begin(), request.markers.end());
  if (!request.angles.empty()) files.insert(files.end(), {request.angles, beside(request.angles, "_sd.sto")});
  return files;
}

Result<analysis::GaitOptions> gait_options(const GaitRequest& request, bool drawn) {
  if (auto s = request.check(drawn); !s) return std::unexpected(s.error());
  analysis::GaitOptions out;
  if (!request.of_movement()) out.choice = analysis::parse_event_choice(request.events).value();
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

nlohmann::ordered_json gait_json(const analysis::Gait& gait) {
  Json out;
  const auto& kind = gait.kind;
  out["type"] = analysis::to_string(kind.manner);
  out["direction"] = analysis::to_string(kind.direction);
  out["turning_deg"] = kind.turn_rad * 180.0 / std::numbers::pi;
  out["turning"] = kind.turning;
  out["speed"] = 1e3 * kind.speed_m_per_s;
  out["stride_time_s"] = std::isfinite(kind.longer_than_s) ? Json(nullptr) : Json(kind.stride_s);
  out["person"] = gait.person.empty() ? Json(nullptr) : Json(gait.person);
  out["plates_out_of_step"] = gait.out_of_step;
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
  if (gait.kind.stride_s > 0.0 && gait.kind.not_gait.empty())
    out += fmt::format("  {}\n", gait.kind.sentence());
  for (const auto& event : gait.events)
    out += fmt::format(
        "  {:<5} {:<11} {:8.3f} {} s  {}\n", data::to_string(event.side), data::to_string(event.what),
        event.time_s,
        std::isfinite(event.sd_s) ? fmt::format("+- {:.3f}", event.sd_s) : std::string("        "),
        event.method);
  return out;
}

}  // namespace kinemark::pipeline
