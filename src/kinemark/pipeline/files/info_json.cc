// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/info_json.h"

#include <fmt/core.h>

#include <string>
#include <string_view>

#include "kinemark/core/utf8.h"

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Json paths(const std::vector<std::filesystem::path>& files) {
  Json list = Json::array();
  for (const auto& file : files) list.push_back(file.string());
  return list;
}

using Json = nlohmann::ordered_json;

constexpr std::size_t kLineLetters = 120;  // beside the key
constexpr std::size_t kNameLetters = 300;
constexpr std::string_view kBesideKey = "\n                  ";

/// "LKneeAngles (angle, deg)"
std::string channel_text(const Json& channel) {
  const auto of = [&](const char* key) { return printable(channel[key].get<std::string>(), kNameLetters); };
  const std::string unit = of("unit");
  return fmt::format("{} ({}{}{})", of("name"), of("kind"), unit.empty() ? "" : ", ", unit);
}

/// "Femur (Pelvis, ball: LTHI LKNE)"
std::string segment_text(const Json& segment) {
  std::string out = printable(segment["name"].get<std::string>(), kNameLetters) + " (";
  if (segment["parent"].is_string())
    out += printable(segment["parent"].get<std::string>(), kNameLetters) + ", " +
           segment["joint_kind"].get<std::string>();
  else
    out += "root";
  const Json& markers = segment["markers"];
  for (std::size_t i = 0; i < markers.size(); ++i)
    out += (i == 0 ? ": " : " ") + printable(markers[i].get<std::string>(), kNameLetters);
  return out + ")";
}

/// "KneeWidth=0.105 m"
std::string parameter_text(const Json& parameter) {
  const std::string unit = parameter["unit"].get<std::string>();
  return fmt::format("{}={}{}{}", printable(parameter["name"].get<std::string>(), kNameLetters),
                     parameter["value"].is_null() ? "?" : parameter["value"].dump(), unit.empty() ? "" : " ",
                     unit);
}

/// "pelvis_imu (0.707 0 0.707 0 first, 3 missing)"
std::string sensor_text(const Json& sensor) {
  std::string out = printable(sensor["name"].get<std::string>(), kNameLetters) + " (";
  const Json& first = sensor["first_w_x_y_z"];
  for (const auto& part : first) out += fmt::format("{:.3g} ", part.get<double>());
  return out + fmt::format("{}, {} missing)", first.empty() ? "none" : "first",
                           sensor["missing"].get<std::int64_t>());
}

/// "/acquisition/lfp (ElectricalSeries, 1000 x 4, 500 Hz, volts)"
std::string beside_text(const Json& object) {
  const auto of = [&](const char* key) { return printable(object[key].get<std::string>(), kNameLetters); };
  std::string out = fmt::format("{} ({}", of("path"), of("type"));
  for (std::size_t d = 0; d < object["shape"].size(); ++d)
    out += fmt::format("{}{}", d == 0 ? ", " : " x ", object["shape"][d].get<std::int64_t>());
  if (object["rate_hz"].is_number()) out += fmt::format(", {:g} Hz", object["rate_hz"].get<double>());
  for (const char* key : {"unit", "lost"})
    if (!object[key].get<std::string>().empty()) out += ", " + of(key);
  return out + ")";
}

/// One entry of a list.
std::string entry_text(const Json& entry) {
  if (entry.is_string()) return printable(entry.get<std::string>(), kNameLetters);
  if (entry.contains("joint_kind")) return segment_text(entry);
  if (entry.contains("first_w_x_y_z")) return sensor_text(entry);
  if (entry.contains("path")) return beside_text(entry);
  return entry.contains("expression") ? parameter_text(entry) : channel_text(entry);
}

/// Names, or channels, one after another, in as many lines as it takes.
std::string in_lines(const Json& names) {
  std::string text;
  std::size_t begin = 0;
  for (const auto& name : names) {
    const std::string word = entry_text(name);
    if (text.size() > begin) {
      if (text.size() - begin + 1 + word.size() > kLineLetters) {
        text += kBesideKey;
        begin = text.size();
      } else {
        text += ' ';
      }
    }
    text += word;
  }
  return text;
}

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json sensors_json(const OrientationFacts& facts) {
  auto sensors = Json::array();
  for (const auto& sensor : facts.sensors)
    sensors.push_back({{"name", sensor.name},
                       {"first_w_x_y_z", sensor.first ? Json(*sensor.first) : Json::array()},
                       {"missing", sensor.missing}});
  return sensors;
}

/// Beside markers.
void add_besides(const OrientationFacts& facts, Json& to) {
  to["orientation_frames"] = facts.frames;
  to["orientation_rate_hz"] = facts.rate_hz;
  to["orientation_first_time_s"] = facts.first_time_s;
  to["orientation_last_time_s"] = facts.last_time_s;
  to["orientation_missing"] = facts.missing;
  to["orientations"] = sensors_json(facts);
}

void add(const MarkerFileFacts& facts, Json& to) {
  to["kind"] = "markers";
  to["format"] = facts.format;
  to["points"] = facts.points;
  to["frames"] = facts.frames;
  to["rate_hz"] = or_null(facts.rate_hz);
  to["first_frame"] = facts.first_frame;
  to["last_frame"] = facts.last_frame;
  to["units"] = facts.units;
  to["missing"] = facts.missing;
  to["analog_channels"] = facts.analog_channels;
  to["analog_rate_hz"] = facts.analog_rate_hz;
  to["force_plates"] = facts.force_plates;
  to["events"] = facts.events;
  to["software"] = facts.software;
  to["labels"] = facts.labels;
  to["computed"] = facts.computed;
  to["unlabelled"] = facts.unlabelled;
  if (facts.set)
    to["marker_set"] = {{"name", facts.set->set->name},
                        {"part", facts.set->set->part},
                        {"markers", facts.set->markers},
                        {"missing", facts.set->missing},
                        {"said", facts.set->describe()}};
  to["channels"] = Json::array();
  for (const ChannelFacts& channel : facts.channels)
    to["channels"].push_back({{"name", channel.name},
                              {"kind", channel.kind},
                              {"unit", channel.unit},
                              {"rate_hz", channel.rate_hz},
                              {"missing", channel.missing}});
  if (facts.orientations) add_besides(*facts.orientations, to);
  if (!facts.up.empty()) to["up"] = facts.up;
  if (!facts.calibration_error.empty()) to["calibration_error"] = facts.calibration_error;
  if (!facts.filtered.empty()) to["filtered"] = facts.filtered;
  for (const auto& object : facts.beside)
    to["beside_movement"].push_back({{"path", object.path},
                                     {"type", object.type},
                                     {"shape", object.shape},
                                     {"rate_hz", object.rate_hz > 0.0 ? Json(object.rate_hz) : Json()},
                                     {"unit", object.unit},
                                     {"lost", object.lost}});
}

void add(const TableFacts& facts, Json& to) {
  to["kind"] = "table";
  to["rows"] = facts.rows;
  to["columns"] = facts.labels.size();
  to["first_time_s"] = or_null(facts.first_time_s);
  to["last_time_s"] = or_null(facts.last_time_s);
  to["in_degrees"] = facts.in_degrees;
  to["labels"] = facts.labels;
}

void add(const OrientationFacts& facts, Json& to) {
  to["kind"] = "orientations";
  to["frames"] = facts.frames;
  to["rate_hz"] = facts.rate_hz;
  to["first_time_s"] = facts.first_time_s;
  to["last_time_s"] = facts.last_time_s;
  to["missing"] = facts.missing;
  to["sensors"] = sensors_json(facts);
}

void add(const ModelFacts& facts, Json& to) {
  to["kind"] = "model";
  to["name"] = facts.name;
  to["bodies"] = facts.body_names.size();
  to["joints"] = facts.joints;
  to["coordinates"] = facts.labels.size();
  to["markers"] = facts.markers;
  to["couplings"] = facts.couplings;
  to["point_constraints"] = facts.point_constraints;
  to["mass_kg"] = facts.mass_kg;
  to["labels"] = facts.labels;
  to["body_names"] = facts.body_names;
  if (!facts.notes.empty()) to["notes"] = facts.notes;
}

void add(const CountsFacts& facts, Json& to) {
  to["frames"] = facts.frames;
  to["rate_hz"] = facts.rate_hz;
  to["first_time_s"] = facts.first_time_s;
  to["rig"] = facts.rig;
  to["dark_slot"] = facts.dark_slot;
  to["saturated"] = facts.saturated;
  to["occluded"] = facts.occluded;
  to["lost"] = facts.lost;
  to["cameras"] = facts.cameras;
  to["labels"] = facts.labels;
}

void add(const RecordingFacts& facts, Json& to) {
  to["kind"] = "recording";
  to["end"] = io::to_string(facts.end);
  to["bytes"] = facts.bytes;
  to["messages"] = facts.messages;
  to["channels"] = facts.channels;
  to["metadata"] = facts.metadata;
  if (facts.counts) add(*facts.counts, to);
}

void add(const io::Vsk& vsk, Json& to) {
  to["kind"] = "skeleton";
  to["model"] = vsk.model;
  to["points"] = vsk.markers.size();
  to["sticks"] = vsk.sticks.size();
  to["segments"] = Json::array();
  for (std::size_t s = 0; s < vsk.segments.size(); ++s) {
    const io::VskSegment& segment = vsk.segments[s];
    Json entry{{"name", segment.name}, {"parent", nullptr}, {"joint", segment.joint}};
    if (segment.parent >= 0) entry["parent"] = vsk.segments[static_cast<std::size_t>(segment.parent)].name;
    entry["joint_kind"] = io::to_string(segment.kind);
    entry["markers"] = Json::array();
    for (const auto& marker : vsk.markers)
      if (marker.segment == static_cast<int>(s)) entry["markers"].push_back(marker.name);
    to["segments"].push_back(std::move(entry));
  }
  to["parameters"] = Json::array();
  for (const auto& parameter : vsk.parameters)
    to["parameters"].push_back({{"name", parameter.name},
                                {"value", or_null(parameter.value)},
                                {"unit", parameter.unit},
                                {"expression", parameter.expression}});
  to["labels"] = Json::array();
  for (const auto& marker : vsk.markers) to["labels"].push_back(marker.name);
}

/// The first finding, and how many there are besides; nothing where there is none.
std::string worst_of(const std::vector<std::string>& contradicted) {
  if (contradicted.empty()) return {};
  const auto more = contradicted.size() - 1;
  return fmt::format("{:<17} {}{}\n", "contradicted", printable_sentence(contradicted.front()),
                     more > 0 ? fmt::format(" (and {} more, which 'kinemark validate' says)", more) : "");
}

}  // namespace

Json outcome_json(const JobOutcome& outcome) {
  return Json{{"written", paths(outcome.written)}, {"warnings", outcome.warnings}};
}

Json validate_json(const ValidateOutcome& outcome) {
  Json list = Json::array();
  for (const auto& checked : outcome.files) {
    Json& entry =
        list.emplace_back(Json{{"file", checked.file.string()}, {"exit_status", checked.exit_status()}});
    if (checked.error)
      entry["error"] = checked.error->message;
    else
      entry["warnings"] = checked.warnings;
    if (!checked.notes.empty()) entry["notes"] = checked.notes;
  }
  return list;
}

Json recover_json(const RecoverOutcome& outcome) {
  Json damage = Json::array();
  for (const auto& one : outcome.damage)
    damage.push_back({{"offset", one.offset}, {"bytes", one.bytes}, {"what", one.what}});
  return Json{{"original", outcome.original.string()},
              {"written", paths(outcome.written)},
              {"messages", outcome.messages},
              {"end", io::to_string(outcome.end)},
              {"bytes_left_out", outcome.bytes_left_out},
              {"damage", std::move(damage)},
              {"warnings", outcome.warnings}};
}

Json info_json(const InfoOutcome& outcome) {
  Json json;
  json["file"] = outcome.file.string();
  std::visit([&json](const auto& facts) { add(facts, json); }, outcome.facts);
  json["warnings"] = outcome.warnings;
  json["contradicted"] = outcome.contradicted;
  return json;
}

std::string info_text(const InfoOutcome& outcome) {
  std::string text;
  const auto json = info_json(outcome);
  for (const auto& [key, value] : json.items()) {
    if (key == "warnings") {
      for (const auto& warning : outcome.warnings)
        text += fmt::format("warning           {}\n", printable_sentence(warning));
    } else if (key == "contradicted") {
      text += worst_of(outcome.contradicted);
    } else if (value.is_object()) {
      text += fmt::format("{:<17} {}\n", key, printable_sentence(value["said"].get<std::string>()));
    } else if (value.is_array()) {
      text += fmt::format("{:<17} {}\n", key, value.empty() ? "none" : in_lines(value));
    } else {
      text += fmt::format("{:<17} {}\n", key,
                          value.is_string() ? printable(value.get<std::string>()) : value.dump());
    }
  }
  return text;
}

}  // namespace kinemark::pipeline
