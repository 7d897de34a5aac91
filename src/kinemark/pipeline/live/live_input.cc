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

#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/core/version.h"
#include "kinemark/data/name_index.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/io/rate.h"
#include "kinemark/pipeline/files/address_settings.h"
#include "kinemark/pipeline/files/model_input.h"
#include "kinemark/pipeline/motion/markers_page.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/report/live_report.h"
#include "kinemark/stages/simulation/sleeve_source.h"
#include "kinemark/stages/simulation/subject_source.h"
#include "kinemark/stream/recorded_source.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSim = "sim:";
constexpr std::string_view kReplay = "replay:";
constexpr std::string_view kArm = "arm";
constexpr std::int64_t kMostSimulatedFrames = 10'000'000;  // what SubjectOptions allow

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

/// A macaque's arm in a sleeve of LEDs; its angles only with a model of it.
Result<LiveInput> open_arm(std::string_view argument, AddressSettings& settings, const fs::path& model_file,
                           std::uint64_t seed) {
  const double rate_hz = settings.number("rate", 60.0, 1.0, 1000.0);
  const simulation::SleeveOptions options{.duration_s = settings.number("seconds", 60.0, 0.1, 36'000.0),
                                          .rate_hz = rate_hz,
                                          .noise_sd_m = 1e-3 * settings.number("noise", 1.0, 0.0, 100.0),
                                          .missing = settings.number("missing", 0.0, 0.0, 0.9),
                                          .seed = seed};
  if (auto s = settings.check(); !s) return std::unexpected(s.error());
  auto source = simulation::SleeveSource::create(options, {.name = std::string(argument)});
  if (!source) return fail_at(std::string(argument), source.error());
  LiveInput out{.source = std::move(*source), .title = "Simulated arm of a macaque"};
  if (model_file.empty()) return out;
  auto model = read_model(model_file);
  if (!model) return std::unexpected(model.error());
  out.model = std::move(*model);
  return out;
}

Result<LiveInput> open_simulation(std::string_view argument, const fs::path& model_file, std::uint64_t seed) {
  AddressSettings settings(argument);
  const std::string name = settings.what().empty() ? "walk" : settings.what();
  if (name == kArm) return open_arm(argument, settings, model_file, seed);
  const auto motion = simulation::parse_motion_kind(name);
  if (!motion) return fail_at(std::string(argument), motion.error());
  const double rate_hz = settings.number("rate", 240.0, 1.0, 1000.0);
  const double duration_s = settings.number("seconds", 60.0, 0.1, 36'000.0);
  const double noise_mm = settings.number("noise", 1.0, 0.0, 100.0);
  const double missing = settings.number("missing", 0.0, 0.0, 0.9);
  if (auto s = settings.check(); !s) return std::unexpected(s.error());
  const simulation::SubjectOptions options{.motion = *motion,
                                           .duration_s = duration_s,
                                           .rate_hz = rate_hz,
                                           .seed = seed,
                                           .noise_sd_m = 1e-3 * noise_mm,
                                           .dropout_random = missing};
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
  AddressSettings settings(argument);
  std::error_code ignored;
  if (fs::exists(argument.substr(kReplay.size()), ignored)) settings.take_all_as_name();
  const double rate_hz = settings.number("rate", 0.0, 0.001, 10'000.0);
  if (auto s = settings.check(); !s) return std::unexpected(s.error());
  if (settings.what().empty()) return fail(Code::usage, "replay: names no file; need replay:FILE");
  const fs::path path(settings.what());
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
