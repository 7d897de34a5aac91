// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/report_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "kinemark/io/file.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/set_mark.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/pipeline/motion/internal/cycle_overlays.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"
#include "kinemark/pipeline/motion/model_meshes.h"
#include "kinemark/stages/report/ik_report.h"
#include "kinemark/workflow/motion/used_markers.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// How the remark begins that a recording was turned (axes.cc); its file is as it was.
constexpr std::string_view kTurnedNote = "the recording was turned";

Result<Json> read_json(const fs::path& path) {
  const auto text = io::read_text(path, 256UL << 20);
  if (!text) return std::unexpected(text.error());
  Json json = Json::parse(*text, nullptr, false);
  if (json.is_discarded()) return fail(Code::bad_input, fmt::format("{}: is not JSON", path.string()));
  return json;
}

/// Names of the rotational coordinates, as written by summary_json().
RotationNames rotations(const Json& json) {
  RotationNames names;
  if (!json.contains("coordinates") || !json["coordinates"].is_array()) return names;
  for (const auto& coordinate : json["coordinates"])
    if (coordinate.value("unit", "") == "deg") {
      const std::string name = coordinate.value("name", "");
      names.all.push_back(name);
      if (coordinate.value("unit_in_tables", "") == "rad") names.keeps_radians.push_back(name);
    }
  return names;
}

/// Frames in which no marker fixes a coordinate, as written by summary_json(); none in earlier versions.
void read_open_frames(const Json& json, data::JointMotion& motion) {
  std::vector<std::int64_t> open;
  for (const auto& coordinate : json.value("coordinates", Json::array()))
    if (const auto frames = coordinate.find("open_frames");
        frames != coordinate.end() && frames->is_number_integer())
      open.push_back(frames->get<std::int64_t>());
  if (std::ssize(open) == motion.size()) motion.open_frames = std::move(open);
}

/// The edits of a run applied to its recording once more; false where their journal is another by now.
bool edit_again(const report::IkRun& run, const fs::path& path, data::Recording& recording) {
  const auto was = std::ranges::find(run.inputs, "edits", &data::InputFile::role);
  if (was == run.inputs.end()) return true;
  const auto is = io::record_input("edits", was->path);
  return is && is->bytes == was->bytes && is->hash == was->hash &&
         take_edits({.edits = was->path, .recording = path}, recording, run.seed).has_value();
}

/// What is still known of a recording.
struct Recorded {
  data::Trajectories states;  ///< on the solved frames
  std::vector<report::CycleOverlay> cycles;
};

/// Of the file of markers, when it is still there and fits; else nothing.
std::optional<Recorded> recorded_of(const report::IkRun& run, const data::JointMotion& motion) {
  for (const auto& input : run.inputs) {
    if (input.role != "markers") continue;
    auto markers = io::read_marker_input({.path = input.path});
    if (!markers) return std::nullopt;
    data::Recording recording{.trial = std::move(markers->trial)};
    if (!edit_again(run, input.path, recording)) return std::nullopt;
    const auto& recorded = recording.trial.markers;
    const auto first = recorded.time.nearest_frame(motion.time.t0_s);
    if (first < 0 || first + motion.frames() > recorded.frames()) return std::nullopt;
    std::vector<std::int64_t> from;
    for (const auto& name : motion.markers) from.push_back(recorded.find(name));
    if (std::ranges::find(from, -1) != from.end()) return std::nullopt;
    auto states = workflow::select_markers(recorded, from, motion.markers, first, motion.time);
    workflow::exchange_as_found(run.fit, states);
    for (const auto& left_out : run.fit.findings) {
      if (left_out.kind != data::FindingKind::outlier) continue;
      const auto marker = states.find(left_out.subject);
      const auto last = std::min(left_out.last_frame, states.frames() - 1);
      for (auto f = left_out.first_frame; marker >= 0 && f >= 0 && f <= last; ++f)
        states.set_missing(f, marker, data::SampleState::rejected);
    }
    return Recorded{.states = std::move(states),
                    .cycles = internal::cycle_overlays(recording.trial.events, recorded.time, motion)};
  }
  return std::nullopt;
}

/// True for the result files of `kinemark ik`; all others are asked for markers.
bool is_solved(const fs::path& path) {
  const std::string ending = ending_of(path);
  return ending == ".mot" || (ending == ".json" && path.stem().string().ends_with("_report"));
}

/// The model of a run, when its file is still there.
std::optional<model::Model> model_of(const report::IkRun& run) {
  const auto file = std::ranges::find(run.inputs, "model", &data::InputFile::role);
  if (file == run.inputs.end() || !fs::is_regular_file(file->path)) return std::nullopt;
  auto description = io::read_osim(file->path);
  if (!description) return std::nullopt;
  auto model = model::Model::compile(std::move(*description));
  if (!model) return std::nullopt;
  return std::move(*model);
}

/// Its bodies, where the motion is of this model.
std::optional<report::SceneBodies> bodies_of(const report::IkRun& run,
                                             const std::optional<model::Model>& model,
                                             const data::JointMotion& motion,
                                             std::span<const fs::path> geometry) {
  if (!model) return std::nullopt;
  const auto& coordinates = model->description().coordinates;
  if (!std::ranges::equal(coordinates, motion.coordinates, {}, &data::CoordinateDescription::name))
    return std::nullopt;
  const auto file = std::ranges::find(run.inputs, "model", &data::InputFile::role);
  return internal::body_positions(*model, motion,
                                  read_model_meshes(file->path, model->description(), geometry));
}

std::string set_of(const Json& json) {
  const auto set = json.find(std::string(io::kSetKey));
  return set != json.end() && set->is_string() ? set->get<std::string>() : "";
}

std::string set_of(const data::Table& table) {
  const auto line = std::ranges::find(table.header, io::kSetKey, [](const auto& pair) { return pair.first; });
  return line == table.header.end() ? "" : line->second;
}

/// A page, and every file that it was made from.
struct Page {
  std::string html;
  std::vector<fs::path> read;
};

/// Numbers of a torque table of the same set and frames; empty where there is no such file.
Array<double> torques_from(const fs::path& path, const data::JointMotion& motion, std::string_view set) {
  if (!fs::is_regular_file(path)) return {};
  const auto read = io::read_table(path);
  if (!read || set_of(*read) != set || read->columns.size() != motion.coordinates.size() ||
      std::ssize(read->values) != motion.frames() * motion.size())
    return {};
  for (std::size_t j = 0; j < motion.coordinates.size(); ++j)
    if (read->columns[j] != motion.coordinates[j] + "_moment" &&
        read->columns[j] != motion.coordinates[j] + "_force")
      return {};
  Array<double> out(read->values.size());
  std::ranges::copy(read->values, out.begin());
  return out;
}

Result<Page> solved_page(const fs::path& solved, std::span<const fs::path> geometry) {
  std::string stem = solved.stem().string();
  if (ending_of(solved) == ".json") stem.resize(stem.size() - 7);
  const fs::path base = solved.parent_path() / (stem + ".mot");
  const auto json = read_json(beside(base, "_report.json"));
  if (!json) return std::unexpected(json.error());
  auto run = report::run_from_json(*json);
  if (!run) return fail_at(beside(base, "_report.json").string(), run.error());
  const auto coordinates = io::read_table(base);
  if (!coordinates) return std::unexpected(coordinates.error());
  const auto deviations = io::read_table(beside(base, "_sd.sto"));
  if (!deviations && fs::exists(beside(base, "_sd.sto"))) return std::unexpected(deviations.error());
  const auto errors = io::read_table(beside(base, "_marker_errors.sto"));
  if (!errors) return std::unexpected(errors.error());
  std::vector<SetMember> members{{beside(base, "_report.json"), set_of(*json)}, {base, set_of(*coordinates)}};
  if (deviations) members.push_back({beside(base, "_sd.sto"), set_of(*deviations)});
  members.push_back({beside(base, "_marker_errors.sto"), set_of(*errors)});
  for (const char* torques : {"_tau.sto", "_tau_sd.sto"})  // of another set they are left out
    if (set_in(beside(base, torques)) == members.front().set)
      members.push_back({beside(base, torques), members.front().set});
  if (auto s = check_same_set(members); !s) return std::unexpected(s.error());
  Page page;
  page.read = {base, beside(base, "_sd.sto"), beside(base, "_marker_errors.sto"),
               beside(base, "_report.json")};
  for (const auto& input : run->inputs) page.read.emplace_back(input.path);
  auto motion =
      motion_from_tables(*coordinates, deviations ? &*deviations : nullptr, &*errors, rotations(*json));
  if (!motion) return fail_at(base.string(), motion.error());
  if (const auto first = json->find("first_frame"); first != json->end() && first->is_number_integer())
    motion->time.first_number = first->get<std::int64_t>();
  read_open_frames(*json, *motion);
  motion->tau = torques_from(beside(base, "_tau.sto"), *motion, set_of(*json));
  if (!motion->tau.empty())
    motion->tau_sd = torques_from(beside(base, "_tau_sd.sto"), *motion, set_of(*json));
  const auto recorded = recorded_of(*run, *motion);
  const auto* states = recorded ? &recorded->states : nullptr;
  const bool turned = std::ranges::any_of(
      run->warnings, [](const auto& sentence) { return sentence.starts_with(kTurnedNote); });
  const auto model = model_of(*run);
  const auto bodies = bodies_of(*run, model, *motion, geometry);
  auto summary = report::summarize(std::move(*run), *motion, states);
  if (!summary) return fail_at(base.string(), summary.error());
  page.html =
      report::report_html({.summary = *summary,
                           .motion = &*motion,
                           .markers = states,
                           .in_model_axes = !turned,
                           .up = model ? workflow::up_of(*model) : std::nullopt,
                           .bodies = bodies ? &*bodies : nullptr,
                           .cycles = recorded ? recorded->cycles : std::vector<report::CycleOverlay>{}});
  return page;
}

Result<Page> make_page(const fs::path& path, const MarkersPageOptions& options) {
  if (auto s = options.recording.check(); !s) return std::unexpected(s.error());
  if (is_solved(path)) {
    if (!options.recording.empty() || !options.skeleton.empty())
      return fail(Code::usage,
                  fmt::format("{}: the options of a recording and --skeleton are for marker files, not for "
                              "joint angles",
                              path.string()));
    if (auto s = check_geometry(options.geometry); !s) return std::unexpected(s.error());
    return solved_page(path, options.geometry);
  }
  if (!options.geometry.empty())
    return fail(Code::usage,
                fmt::format("{}: --geometry is for joint angles, which have a model, not for marker files",
                            path.string()));
  if (!options.skeleton.empty() && ending_of(path) != ".amc")
    return fail(Code::usage,
                fmt::format("--skeleton: {} has none beside it; it is for .amc files", path.string()));
  auto html = markers_page(path, options);
  if (!html) return std::unexpected(html.error());
  return Page{.html = std::move(*html), .read = files_of(path, options.recording)};
}

}  // namespace

Result<std::string> page_of(const fs::path& path, const MarkersPageOptions& options) {
  auto page = make_page(path, options);
  if (!page) return std::unexpected(page.error());
  return std::move(page->html);
}

Result<ReportOutcome> run_report(const ReportJob& job) {
  if (auto s = check_ending(job.page, {".html"}, "a page is"); !s) return std::unexpected(s.error());
  auto page = make_page(job.input, {.recording = job,
                                    .skeleton = job.skeleton,
                                    .command_line = job.command_line,
                                    .geometry = job.geometry});
  if (!page) return std::unexpected(page.error());
  if (auto s = check_apart(job, {job.page}, page->read); !s) return std::unexpected(s.error());
  if (auto s = io::write_text(job.page, page->html, job.force); !s) return std::unexpected(s.error());
  ReportOutcome out;
  out.written = {job.page};
  return out;
}

}  // namespace kinemark::pipeline
