// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>

#include "kinemark/core/units.h"
#include "kinemark/data/frame_list.h"
#include "kinemark/stages/report/ik_summary.h"
#include "kinemark/stages/report/internal/json_parts.h"

namespace kinemark::report {

namespace {

using Json = nlohmann::ordered_json;

using internal::findings_json;
using internal::gates_json;
using internal::millimetres;
using internal::number;
using internal::options_json;

constexpr int kSchemaVersion = 2;  // 1 counted frames of the motion from 0

/// deg to 1e-4, m to 1e-6.
Json coordinate_value(const CoordinateSummary& c, double value) {
  return c.is_rotation ? number(kDegPerRad * value, 4) : number(value, 6);
}

Json limits_json(const CoordinateSummary& c) {
  if (!std::isfinite(c.limit_min) || !std::isfinite(c.limit_max)) return nullptr;
  return Json::array({coordinate_value(c, c.limit_min), coordinate_value(c, c.limit_max)});
}

Json coordinates_json(const IkSummary& s) {
  Json out = Json::array();
  for (const CoordinateSummary& c : s.coordinates)
    out.push_back({{"name", c.name},
                   {"unit", c.is_rotation ? "deg" : "m"},
                   {"unit_in_tables", c.is_rotation ? (c.keeps_radians ? "rad" : "deg") : "m"},
                   {"locked", c.locked},
                   {"determined_frames", c.determined_frames},
                   {"open_frames", c.open_frames < 0 ? Json() : Json(c.open_frames)},
                   {"min", coordinate_value(c, c.min)},
                   {"max", coordinate_value(c, c.max)},
                   {"median_sd", coordinate_value(c, c.median_sd)},
                   {"limits", limits_json(c)},
                   {"at_limit_frames", c.at_limit_frames}});
  return out;
}

Json markers_json(const IkSummary& s) {
  Json out = Json::array();
  for (const MarkerRow& m : s.markers)
    out.push_back(
        {{"name", m.name},
         {"used", m.used},
         {"why_excluded", m.why_excluded},
         {"weight", number(m.weight, 6)},
         {"seen_frames", m.seen_frames},
         {"rejected_frames", m.rejected_frames},
         {"rms_error_mm", millimetres(m.rms_error_m)},
         {"max_error_mm", millimetres(m.max_error_m)},
         {"max_error_time_s", number(m.max_error_frame < 0 ? kNaN : s.time.time_s(m.max_error_frame), 6)},
         {"noise_sd_mm", millimetres(m.noise_sd_m)}});
  return out;
}

/// Every span of samples that was left out, in the recording's numbers, both ends included.
Json rejected_json(const IkSummary& s) {
  Json out = Json::array();
  for (const data::Finding& f : s.run.fit.findings)
    if (f.kind == data::FindingKind::outlier)
      out.push_back({{"marker", f.subject},
                     {"first_frame", s.time.number(f.first_frame)},
                     {"last_frame", s.time.number(f.last_frame)},
                     {"first_time_s", number(s.time.time_s(f.first_frame), 6)},
                     {"last_time_s", number(s.time.time_s(f.last_frame), 6)},
                     {"distance_mm", millimetres(f.size)},
                     {"why", f.detail}});
  return out;
}

/// Every two markers whose labels were exchanged back, and in which frames, in the recording's numbers.
Json exchanged_json(const IkSummary& s) {
  Json out = Json::array();
  for (const data::Finding& f : s.run.fit.findings) {
    if (f.kind != data::FindingKind::label_swap) continue;
    std::vector<std::int64_t> frames = f.frames;
    for (auto frame = f.first_frame; f.frames.empty() && frame <= f.last_frame; ++frame)
      frames.push_back(frame);
    for (auto& frame : frames) frame = s.time.number(frame);
    out.push_back({{"marker", f.subject},
                   {"other", f.partner},
                   {"frames", data::format_frame_list(frames)},
                   {"count", frames.size()},
                   {"apart_mm", millimetres(f.size)}});
  }
  return out;
}

Json worst_frames_json(const IkSummary& s) {
  Json out = Json::array();
  for (const WorstFrame& w : s.worst_frames)
    out.push_back({{"frame", s.time.number(w.frame)},
                   {"time_s", number(w.time_s, 6)},
                   {"rms_error_mm", millimetres(w.rms_error_m)},
                   {"markers_seen", w.markers_seen},
                   {"worst_marker", w.marker},
                   {"worst_marker_error_mm", millimetres(w.marker_error_m)},
                   {"status", data::to_string(w.status)}});
  return out;
}

Json status_json(const IkSummary& s) {
  Json out = Json::object();
  for (std::size_t i = 0; i < s.status_frames.size(); ++i)
    out[std::string(data::to_string(static_cast<data::FrameStatus>(i)))] = s.status_frames[i];
  return out;
}

double metres(const Json& object, const char* key) {
  const Json& value = object.at(key);
  return value.is_null() ? kNaN : 1e-3 * value.get<double>();
}

/// The number of the motion's first frame in the lists of a report: reports of version 1 count from 0.
std::int64_t first_number(const Json& json) {
  if (json.at("schema_version") == 1) return 0;
  return json.value("first_frame", std::int64_t{0});
}

/// What rejected_json() wrote.
std::vector<data::Finding> read_rejected(const Json& json) {
  const auto first = first_number(json);
  std::vector<data::Finding> findings;
  for (const Json& r : json.value("rejected", Json::array()))
    findings.push_back({.kind = data::FindingKind::outlier,
                        .subject = r.at("marker"),
                        .first_frame = r.at("first_frame").get<std::int64_t>() - first,
                        .last_frame = r.at("last_frame").get<std::int64_t>() - first,
                        .size = metres(r, "distance_mm"),
                        .detail = r.at("why")});
  return findings;
}

/// What exchanged_json() wrote; reports of earlier versions have none.
void add_exchanged(const Json& json, std::vector<data::Finding>& findings) {
  for (const Json& e : json.value("exchanged", Json::array())) {
    auto frames = data::parse_frame_list(e.at("frames").get<std::string>());
    if (!frames || frames->empty()) continue;
    for (auto& frame : *frames) frame -= first_number(json);
    findings.push_back({.kind = data::FindingKind::label_swap,
                        .subject = e.at("marker"),
                        .partner = e.at("other"),
                        .first_frame = frames->front(),
                        .last_frame = frames->back(),
                        .frames = std::move(*frames),
                        .size = metres(e, "apart_mm")});
  }
}

/// Whether it is locked, and its limits; reports of earlier versions have none.
void add_coordinate(const Json& c, IkRun& run) {
  if (c.at("locked").get<bool>()) run.locked_coordinates.push_back(c.at("name"));
  const Json limits = c.value("limits", Json());
  if (!limits.is_array()) return;
  const double unit = c.at("unit") == "deg" ? kRadPerDeg : 1.0;
  run.limits.push_back({c.at("name"), unit * limits.at(0).get<double>(), unit * limits.at(1).get<double>()});
}

IkRun read_run(const Json& json) {
  IkRun run;
  json.at("trial").get_to(run.trial);
  json.at("model").get_to(run.model);
  json.at("method").get_to(run.method);
  json.at("version").get_to(run.version);
  json.at("command_line").get_to(run.command_line);
  json.at("seed").get_to(run.seed);
  json.at("threads").get_to(run.threads);
  json.at("exit_status").get_to(run.exit_status);
  if (!json.at("solve_s").is_null()) json.at("solve_s").get_to(run.solve_s);
  for (const auto& [key, value] : json.at("options").get_ref<const Json::object_t&>())
    run.options.emplace_back(key, value.get<std::string>());
  for (const Json& i : json.at("inputs"))
    run.inputs.push_back({i.at("role"), i.at("path"), i.at("bytes"), i.at("hash"), i.at("hash_kind")});
  for (const Json& g : json.at("gates")) {
    const auto value = [&](const char* key) { return g.at(key).is_null() ? kNaN : g.at(key).get<double>(); };
    run.gates.push_back(
        {g.at("name"), g.at("passed"), value("value"), value("bound"), g.at("unit"), g.at("sentence")});
  }
  const bool judged = json.contains("rejected_fraction") && !json["rejected_fraction"].is_null();
  for (const Json& m : json.at("markers")) {
    const auto why = m.at("why_excluded").get<std::string>();
    if (why.empty()) {
      run.fit.markers.push_back({.name = m.at("name"),
                                 .weight = m.at("weight").is_null() ? 1.0 : m.at("weight").get<double>(),
                                 .noise_sd_m = metres(m, "noise_sd_mm"),
                                 .common_sd_m = 0.0});  // the file holds both together
      if (judged) run.fit.markers.back().rejected_frames = m.at("rejected_frames");
    } else {
      run.fit.excluded.push_back({m.at("name"), why});
    }
  }
  run.fit.findings = read_rejected(json);
  add_exchanged(json, run.fit.findings);
  for (const Json& c : json.at("coordinates")) add_coordinate(c, run);
  if (const Json mass = json.value("mass_kg", Json()); mass.is_number()) mass.get_to(run.mass_kg);
  json.at("warnings").get_to(run.warnings);
  return run;
}

}  // namespace

nlohmann::ordered_json summary_json(const IkSummary& s) {
  const IkRun& run = s.run;
  const auto frames = static_cast<double>(s.time.frames);
  return {{"schema", "kinemark.ik_report"},
          {"schema_version", kSchemaVersion},
          {"trial", run.trial},
          {"model", run.model},
          {"method", run.method},
          {"verdict", to_string(s.verdict)},
          {"exit_status", run.exit_status},
          {"frames", s.time.frames},
          {"rate_hz", number(s.time.rate_hz, 6)},
          {"first_time_s", number(s.time.t0_s, 6)},
          {"first_frame", s.time.first_number},
          {"solve_s", number(run.solve_s, 9)},
          {"frames_per_s", number(run.solve_s > 0.0 ? frames / run.solve_s : kNaN, 1)},
          {"threads", run.threads},
          {"seed", run.seed},
          {"version", run.version},
          {"command_line", run.command_line},
          {"rms_error_mm", millimetres(s.rms_error_m)},
          {"max_error_mm", millimetres(s.max_error_m)},
          {"determined_fraction", number(s.determined_fraction, 6)},
          {"status_frames", status_json(s)},
          {"rejected_samples", s.rejected_samples},
          {"rejected_fraction", number(s.rejected_fraction, 6)},
          {"rejected", rejected_json(s)},
          {"exchanged", exchanged_json(s)},
          {"findings", findings_json(s.notices)},
          {"gates", gates_json(run.gates)},
          {"mass_kg", number(run.mass_kg, 3)},
          {"coordinates", coordinates_json(s)},
          {"markers", markers_json(s)},
          {"worst_frames", worst_frames_json(s)},
          {"options", options_json(run.options)},
          {"inputs", inputs_json(run.inputs)},
          {"warnings", run.warnings}};
}

Result<IkRun> run_from_json(const nlohmann::ordered_json& json) {
  if (!json.is_object() || json.value("schema", Json()) != "kinemark.ik_report")
    return fail(Code::bad_input,
                "this JSON is not a kinemark IK report; need \"schema\": \"kinemark.ik_report\"");
  if (const auto version = json.value("schema_version", Json()); version != 1 && version != kSchemaVersion)
    return fail(Code::not_supported,
                fmt::format("the report's schema_version is {}; this program reads 1 and {}", version.dump(),
                            kSchemaVersion));
  try {
    return read_run(json);
  } catch (const Json::exception& e) {
    return fail(Code::bad_input, fmt::format("the report's JSON does not follow its schema: {}", e.what()));
  }
}

}  // namespace kinemark::report
