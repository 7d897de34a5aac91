// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/live/live_input.h"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/core/version.h"
#include "kinemark/data/name_index.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/io/rate.h"
#include "kinemark/pipeline/files/model_input.h"
#include "kinemark/pipeline/motion/markers_page.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/report/live_report.h"
#include "kinemark/stages/simulation/subject_source.h"
#include "kinemark/stream/recorded_source.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSim = "sim:";
constexpr std::string_view kReplay = "replay:";
constexpr std::int64_t kMostSimulatedFrames = 10'000'000;  // what SubjectOptions allow

/// A setting of a source: its name, its value, and the range that the value must lie in.
struct Setting {
  std::string_view name;
  double value, low, high;
};

/// Put "name=value&name=value" into the settings.
Status take_settings(std::string_view source, std::string_view text, std::vector<Setting>& settings) {
  std::vector<std::string> known;
  for (const auto& s : settings) known.emplace_back(s.name);
  while (!text.empty()) {
    const auto end = std::min(text.find('&'), text.size());
    const auto one = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const auto equals = std::min(one.find('='), one.size());
    const auto setting = std::ranges::find(settings, one.substr(0, equals), &Setting::name);
    if (setting == settings.end())
      return fail(Code::usage, fmt::format("{}: '{}' is no setting of it; those are {}", source,
                                           one.substr(0, equals), join(known)));
    const auto value = parse_number(one.substr(std::min(equals + 1, one.size())));
    if (!value || !(*value >= setting->low && *value <= setting->high))
      return fail(Code::usage, fmt::format("{}: {} must be a number from {:g} to {:g}", source, setting->name,
                                           setting->low, setting->high));
    setting->value = *value;
  }
  return {};
}

Result<std::shared_ptr<const model::Model>> read_model(const fs::path& path) {
  auto input = read_model_input(path);
  if (!input) return std::unexpected(input.error());
  return std::make_shared<const model::Model>(std::move(input->model));
}

Result<std::shared_ptr<const model::Model>> own_human() {
  auto description = human_model();
  if (!description) return std::unexpected(description.error());
  auto model = model::Model::compile(*description);
  if (!model) return std::unexpected(model.error());
  return std::make_shared<const model::Model>(std::move(*model));
}

Result<LiveInput> open_simulation(std::string_view argument, const fs::path& model_file, std::uint64_t seed) {
  const auto text = argument.substr(kSim.size());
  const auto question = std::min(text.find('?'), text.size());
  const auto name = question == 0 ? std::string_view("walk") : text.substr(0, question);
  const auto motion = simulation::parse_motion_kind(name);
  if (!motion) return fail_at(std::string(argument), motion.error());
  std::vector<Setting> settings{{"rate", 240.0, 1.0, 1000.0},
                                {"seconds", 60.0, 0.1, 36'000.0},
                                {"noise", 1.0, 0.0, 100.0},
                                {"missing", 0.0, 0.0, 0.9}};
  if (auto s = take_settings(argument, text.substr(std::min(question + 1, text.size())), settings); !s)
    return std::unexpected(s.error());
  const simulation::SubjectOptions options{.motion = *motion,
                                           .duration_s = settings[1].value,
                                           .rate_hz = settings[0].value,
                                           .seed = seed,
                                           .noise_sd_m = 1e-3 * settings[2].value,
                                           .dropout_random = settings[3].value};
  if (options.frames() > kMostSimulatedFrames)
    return fail(Code::usage, fmt::format("{}: would be {} frames; need at most {}", argument,
                                         options.frames(), kMostSimulatedFrames));
  auto model = model_file.empty() ? own_human() : read_model(model_file);
  if (!model) return std::unexpected(model.error());
  stream::SourceFacts facts{.name = std::string(argument)};
  if (const auto up = workflow::up_of(**model)) {
    facts.up = *up;
    facts.up_from = "the model's gravity";
  }
  auto source = simulation::SubjectSource::create(*model, options, std::move(facts));
  if (!source) return fail_at(std::string(argument), source.error());
  return LiveInput{.source = std::move(*source),
                   .title = fmt::format("Simulated subject, {}", name),
                   .model = std::move(*model)};
}

Result<LiveInput> open_replay(std::string_view argument, const fs::path& model_file) {
  auto file = argument.substr(kReplay.size());
  std::vector<Setting> settings{{"rate", 0.0, 0.001, 10'000.0}};
  std::error_code ignored;
  if (const auto question = file.rfind('?');
      question != std::string_view::npos && !fs::exists(file, ignored)) {
    if (auto s = take_settings(argument, file.substr(question + 1), settings); !s)
      return std::unexpected(s.error());
    file = file.substr(0, question);
  }
  if (file.empty()) return fail(Code::usage, "replay: names no file; need replay:FILE");
  const fs::path path(file);
  const double rate_hz = settings[0].value;
  auto input = io::read_marker_input(
      {.path = path, .rate_hz = rate_hz, .rate = io::RateRule::where_needed, .needs_samples = true});
  if (!input) return std::unexpected(input.error());
  LiveInput out{.title = printable(path.filename().string(), 200), .file = path};
  if (!model_file.empty()) {
    auto model = read_model(model_file);
    if (!model) return std::unexpected(model.error());
    out.model = std::move(*model);
  }
  const auto found = out.model ? workflow::find_vertical(input->trial, *out.model) : std::nullopt;
  const auto vertical = found ? *found : vertical_without_model(input->trial);
  auto markers = std::move(input->trial.markers);
  if (rate_hz > 0.0) markers.time.rate_hz = rate_hz;
  out.source = std::make_unique<stream::RecordedSource>(
      std::move(markers),
      stream::SourceFacts{.name = std::string(argument), .up = vertical.up, .up_from = vertical.from});
  return out;
}

/// Bodies, levels and the markers that the model follows.
void add_body(const model::Model& model, const motion::TrackOptions& track, report::LiveReport& report) {
  const auto& description = model.description();
  for (const auto& body : model.bodies())
    report.bodies.push_back({.name = description.bodies[static_cast<std::size_t>(body.description_idx)].name,
                             .parent = body.parent,
                             .mass_kg = body.mass,
                             .com_in_body = body.com_in_body});
  report.strict = track.strict;
  std::map<std::string, int, std::less<>> level_of;
  for (const auto& level : track.levels) {
    const auto index = static_cast<int>(report.levels.size());
    for (const auto& name : level.markers) level_of.emplace(name, index);
    auto names = level.names();
    std::ranges::replace(names, "*", "all others");
    report.levels.push_back(join(names));
  }
  if (track.levels.empty()) {
    report.levels.emplace_back("all markers");
    level_of.emplace("*", 0);
  }
  const data::NameIndex source(report.markers);
  for (std::size_t m = 0; m < description.markers.size(); ++m) {
    const auto& name = description.markers[m].name;
    const auto marker = source.find(name);
    const auto named = level_of.find(name), level = named != level_of.end() ? named : level_of.find("*");
    if (marker < 0 || level == level_of.end()) continue;
    report.targets.push_back({.marker = static_cast<int>(marker),
                              .body = model.markers()[m].body,
                              .x_in_body = model.markers()[m].x_in_body,
                              .level = level->second});
  }
}

}  // namespace

bool names_live_input(std::string_view argument) {
  return argument.starts_with(kSim) || argument.starts_with(kReplay);
}

Result<LiveInput> open_live_input(std::string_view argument, const fs::path& model, std::uint64_t seed) {
  if (argument.starts_with(kSim)) return open_simulation(argument, model, seed);
  if (argument.starts_with(kReplay)) return open_replay(argument, model);
  return fail(Code::usage,
              fmt::format("{}: is no live source; need sim:MOTION or replay:FILE", printable(argument, 200)));
}

std::string live_page(const LiveInput& input, const fs::path& recording, const motion::TrackOptions& track) {
  const auto& facts = input.source->facts();
  report::LiveReport report{.title = input.title,
                            .source = facts.name,
                            .version = std::string(kVersion),
                            .recording = recording.filename().string(),
                            .rate_hz = facts.rate_hz,
                            .markers = facts.markers,
                            .up = facts.up,
                            .up_from = facts.up_from,
                            .extent_m = facts.extent_m};
  if (input.model) {
    for (const auto& coordinate : input.model->description().coordinates)
      report.coordinates.push_back({.name = coordinate.name, .is_rotation = coordinate.is_rotation});
    add_body(*input.model, track, report);
  }
  return report::live_report_html(report);
}

}  // namespace kinemark::pipeline
