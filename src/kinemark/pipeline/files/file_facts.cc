// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/file_facts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/recording/survey.h"
#include "kinemark/io/text/table_file.h"

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Result<Json> describe_markers(const std::filesystem::path& path, double rate_hz) {
  const bool no_rate = io::needs_rate(path) && rate_hz == 0.0;
  const auto trial = io::read_markers(path, {.rate_hz = no_rate ? 1.0 : rate_hz});
  if (!trial) return std::unexpected(trial.error());
  const auto& markers = trial->markers;
  return Json{{"file", path.string()},
              {"kind", "markers"},
              {"format", trial->format},
              {"points", markers.markers()},
              {"frames", markers.frames()},
              {"rate_hz", no_rate ? Json() : Json(markers.time.rate_hz)},
              {"first_frame", trial->first_frame},
              {"last_frame", trial->last_frame()},
              {"units", trial->units_in_file},
              {"missing", markers.count_missing()},
              {"analog_channels", trial->analog.names.size()},
              {"analog_rate_hz", trial->analog.rate_hz},
              {"force_plates", trial->force_plates.size()},
              {"events", trial->events.size()},
              {"software", trial->software},
              {"labels", markers.names},
              {"warnings", trial->warnings}};
}

Result<Json> describe_table(const std::filesystem::path& path) {
  const auto table = io::read_table(path);
  if (!table) return std::unexpected(table.error());
  return Json{{"file", path.string()},
              {"kind", "table"},
              {"rows", table->rows()},
              {"columns", table->columns.size()},
              {"first_time_s", table->rows() > 0 ? Json(table->time_s.front()) : Json()},
              {"last_time_s", table->rows() > 0 ? Json(table->time_s.back()) : Json()},
              {"in_degrees", io::angles_are_degrees(*table)},
              {"labels", table->columns},
              {"warnings", table->warnings}};
}

Result<Json> describe_model(const std::filesystem::path& path) {
  const auto model = io::read_osim(path);
  if (!model) return std::unexpected(model.error());
  double mass = 0.0;
  for (const auto& body : model->bodies) mass += body.mass;
  std::vector<std::string> coordinates, bodies;
  for (const auto& body : model->bodies) bodies.push_back(body.name);
  for (const auto& coordinate : model->coordinates) coordinates.push_back(coordinate.name);
  return Json{{"file", path.string()},
              {"kind", "model"},
              {"name", model->name},
              {"bodies", model->bodies.size()},
              {"joints", model->joints.size()},
              {"coordinates", model->coordinates.size()},
              {"markers", model->markers.size()},
              {"couplings", model->couplings.size()},
              {"point_constraints", model->point_constraints.size()},
              {"mass_kg", mass},
              {"labels", coordinates},
              {"body_names", bodies},
              {"warnings", model->warnings}};
}

/// What the counts of a recording are, and how many of their sightings are flawed.
Status add_counts(const std::filesystem::path& path, Json& facts) {
  const auto recording = io::read_counts(path);
  if (!recording) return std::unexpected(recording.error());
  const data::Counts& counts = recording->counts;
  facts["frames"] = counts.frames();
  facts["rate_hz"] = counts.time.rate_hz;
  facts["first_time_s"] = counts.time.t0_s;
  facts["rig"] = counts.rig_id;
  facts["dark_slot"] = counts.has_dark_slot();
  const auto flagged = [&counts](data::CountFlag flag) {
    return std::ranges::count_if(counts.flags, [flag](std::uint8_t flags) { return (flags & flag) != 0; });
  };
  facts["saturated"] = flagged(data::kCountSaturated);
  facts["occluded"] = flagged(data::kCountOccluded);
  facts["lost"] = flagged(data::kCountLost);
  facts["cameras"] = counts.cameras;
  facts["labels"] = counts.leds;
  return {};
}

Result<Json> describe_recording(const std::filesystem::path& path) {
  const auto survey = io::survey_recording(path);
  if (!survey) return std::unexpected(survey.error());
  Json facts{{"file", path.string()},    {"kind", "recording"},          {"end", io::to_string(survey->end)},
             {"bytes", survey->bytes},   {"messages", survey->messages}, {"channels", Json::array()},
             {"metadata", Json::array()}};
  for (const auto& channel : survey->channels) facts["channels"].push_back(channel.topic);
  for (const auto& metadata : survey->metadata) facts["metadata"].push_back(metadata.name);
  if (std::ranges::any_of(survey->channels, io::carries_counts))
    if (auto s = add_counts(path, facts); !s) return std::unexpected(s.error());
  facts["warnings"] = survey->warnings;
  return facts;
}

}  // namespace

Result<Json> describe_file(const std::filesystem::path& path, double rate_hz) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".osim") return describe_model(path);
  if (ending == ".mot" || ending == ".sto") return describe_table(path);
  if (ending == ".mcap") return describe_recording(path);
  return describe_markers(path, rate_hz);
}

std::string facts_text(const Json& facts) {
  std::string text;
  for (const auto& [key, value] : facts.items()) {
    if (value.is_array()) {
      if (key == "warnings") {
        for (const auto& warning : value)
          text += fmt::format("warning           {}\n", warning.get<std::string>());
        continue;
      }
      std::string list;
      for (const auto& item : value) list += (list.empty() ? "" : " ") + item.get<std::string>();
      text += fmt::format("{:<17} {}\n", key, list);
    } else {
      text += fmt::format("{:<17} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
  return text;
}

}  // namespace kinemark::pipeline
