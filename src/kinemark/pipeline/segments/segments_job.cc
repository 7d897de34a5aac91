// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/segments_job.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "kinemark/data/name_index.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/foundations/foundation_gate.h"
#include "kinemark/pipeline/gait/sheet_inputs.h"
#include "kinemark/pipeline/segments/definition_file.h"
#include "kinemark/pipeline/segments/internal/segment_files.h"
#include "kinemark/pipeline/segments/modelled_points.h"
#include "kinemark/pipeline/segments/segment_tables.h"
#include "kinemark/pipeline/segments/subject_values.h"
#include "kinemark/workflow/prepare/marker_screening.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

/// All that is read. Formulas see the markers with modelled points where some stand in for markers.
struct Files {
  Recording recording;
  std::unique_ptr<data::Trial> static_trial;  // null: none, or the recording
  bool static_is_recording = false;
  std::map<std::string, std::unique_ptr<data::Trial>> trials;
  std::map<const data::Trial*, std::unique_ptr<MarkersAndModelled>> modelled;

  [[nodiscard]] const data::Trajectories* markers_of(const data::Trial& trial) const {
    const auto at = modelled.find(&trial);
    return at == modelled.end() ? &trial.markers : &at->second->markers;
  }
};

/// A recording beside the one that is measured is used as that one is, but whole and by its own journal.
RecordingOptions beside_options(const SegmentsJob& job) {
  RecordingOptions out;
  out.rate_hz = job.rate_hz;
  if (job.edits.empty() || job.edits == kEditsNone) out.edits = kEditsNone;
  out.axes = job.axes;
  return out;
}

/// @param options  those of the recording, or beside_options()
Result<Recording> read_one(const SegmentsJob& job, const fs::path& path, const RecordingOptions& options,
                           SegmentsOutcome& outcome) {
  const bool alone = job.static_trial.empty() && job.trials.empty();
  auto read = open_recording({.path = path,
                              .rate = alone ? RateRule::given : RateRule::where_needed,
                              .needs_samples = true,
                              .record = true,
                              .plates = path == job.input,
                              .forces = path == job.input ? job.forces : fs::path{},
                              .force = job.force,
                              .seed = job.seed,
                              .threads = job.threads},
                             options);
  if (!read) return std::unexpected(read.error());
  outcome.inputs.push_back(std::move(read->file));
  if (read->journal.file) outcome.inputs.push_back(*read->journal.file);
  std::ranges::move(read->forces, std::back_inserter(outcome.inputs));
  std::ranges::move(std::exchange(read->trial.warnings, {}), std::back_inserter(outcome.warnings));
  std::ranges::move(read->notes, std::back_inserter(outcome.warnings));
  if (auto s = workflow::leave_out_defects(read->trial, !job.drops_doubtful(true), read->edits.swapped,
                                           outcome.warnings);
      !s)
    return fail_at(path.string(), s.error());
  return read;
}

Result<std::unique_ptr<data::Trial>> read_beside(const SegmentsJob& job, const fs::path& path,
                                                 SegmentsOutcome& outcome) {
  auto read = read_one(job, path, beside_options(job), outcome);
  if (!read) return std::unexpected(read.error());
  return std::make_unique<data::Trial>(std::move(read->trial));
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) && !error;
}

/// Every file that the job reads, but those that it finds beside and in others.
std::vector<fs::path> files_of(const SegmentsJob& job) {
  auto files = pipeline::files_of(job.input, job);
  std::ranges::move(pipeline::files_of(job.gait), std::back_inserter(files));
  files.insert(files.end(), {job.definition, job.static_trial, job.vsk, job.forces});
  if (!job.static_trial.empty()) files.push_back(edits_of(job.static_trial));
  for (const auto& text : job.trials) {
    files.emplace_back(text.substr(text.find('=') + 1));
    files.push_back(edits_of(files.back()));
  }
  return files;
}

Result<Files> read_files(const SegmentsJob& job, SegmentsOutcome& outcome) {
  Files out;
  auto recording = read_one(job, job.input, job, outcome);
  if (!recording) return std::unexpected(recording.error());
  out.recording = std::move(*recording);
  out.static_is_recording = !job.static_trial.empty() && same_file(job.static_trial, job.input);
  if (!job.static_trial.empty() && !out.static_is_recording) {
    auto trial = read_beside(job, job.static_trial, outcome);
    if (!trial) return std::unexpected(trial.error());
    out.static_trial = std::move(*trial);
  }
  for (const auto& text : job.trials) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      return fail(Code::usage, fmt::format("'{}' is not NAME=FILE", text));
    auto trial = read_beside(job, text.substr(equals + 1), outcome);
    if (!trial) return std::unexpected(trial.error());
    out.trials[text.substr(0, equals)] = std::move(*trial);
  }
  return out;
}

// Modelled points under names that the definition has for markers of which there are no samples.
void take_modelled_points(const data::Trial& trial, const std::string& file,
                          const std::set<std::string>& wanted, Files& files,
                          std::vector<std::string>& warnings) {
  auto found = with_modelled_points(trial, wanted);
  if (!found) return;
  warnings.push_back(fmt::format("{}: not measured, taken as a model of the file has them: {}", file,
                                 fmt::join(found->points, ", ")));
  files.modelled[&trial] = std::make_unique<MarkersAndModelled>(std::move(*found));
}

// Modelled points of all trials, and names of outputs in them.
void join_points(const SegmentsJob& job, const analysis::SegmentDefinition& definition, Files& files,
                 analysis::SegmentInput& input, std::vector<std::string>& warnings) {
  const auto wanted = names_of_points(definition);
  const auto take = [&](const data::Trial& trial, const fs::path& path) {
    take_modelled_points(trial, path.filename().string(), wanted, files, warnings);
    for (auto& [name, theirs] : suffixed_names(trial.markers.names, wanted))
      input.aliases.try_emplace(name, theirs);
    return files.markers_of(trial);
  };
  input.markers = take(files.recording.trial, job.input);
  if (files.static_is_recording) input.static_trial = input.markers;
  if (files.static_trial) input.static_trial = take(*files.static_trial, job.static_trial);
  for (const auto& [name, trial] : files.trials) input.trials[name] = take(*trial, name);
}

// Laboratories whose marker set has a knee alignment device or medial markers measure the wands' offsets.
bool measures_offsets(const data::Trial& trial) {
  for (const auto& group : trial.foreign) {
    if (group.name != "SUBJECTS") continue;
    for (const auto& parameter : group.parameters) {
      if (!parameter.name.starts_with("MARKER_SET")) continue;
      std::string text;
      for (const auto byte : parameter.values)
        text += static_cast<char>(std::toupper(static_cast<unsigned char>(byte)));
      if (text.find("KAD") != std::string::npos || text.find("MED") != std::string::npos) return true;
    }
  }
  return std::ranges::any_of(trial.markers.names, [](const std::string& name) {
    const auto plain = data::without_prefix(name);
    return plain.size() >= 4 && (plain.substr(1) == "KAX" || plain.substr(1) == "MED" ||
                                 plain.substr(1) == "KNEMED" || plain.substr(1) == "KD1");
  });
}

Eigen::Vector3d up_of(const SegmentsJob& job, const data::Trial& trial) {
  if (const auto stated = workflow::stated_vertical(job.axes)) return stated->up;
  if (const auto plates = workflow::vertical_of_plates(trial)) return plates->up;
  if (const auto screen_up = workflow::vertical_of_screen(trial)) return screen_up->up;
  return Eigen::Vector3d::UnitZ();
}

Status find_values(const SegmentsJob& job, const analysis::SegmentDefinition& definition, const Files& files,
                   analysis::SegmentInput& input, SegmentsOutcome& outcome) {
  for (const auto& text : job.subject) {
    auto value = parse_subject_value(text, definition);
    if (!value) return std::unexpected(value.error());
    input.given.push_back(std::move(*value));
  }
  const auto take = [&](std::vector<analysis::SubjectValue> values) {
    mend_units(values, definition, outcome.warnings);
    std::ranges::move(values, std::back_inserter(input.known));
  };
  if (!job.vsk.empty()) {
    auto values = read_subject_file(job.vsk, definition);
    if (!values) return std::unexpected(values.error());
    outcome.inputs.push_back({.role = "subject", .path = job.vsk.string()});
    take(std::move(*values));
  }
  take(subject_values(files.recording.trial, definition));
  input.zeros_doubtful = measures_offsets(files.recording.trial);
  if (files.static_trial) {
    take(subject_values(*files.static_trial, definition));
    input.zeros_doubtful = input.zeros_doubtful || measures_offsets(*files.static_trial);
  }
  return {};
}

// What a reader of a static trial's angles must know: they jump against those of walks.
void note_static_angles(const Files& files, SegmentsOutcome& outcome) {
  if (!files.static_is_recording) return;
  constexpr double kSeen_rad = 0.1 * std::numbers::pi / 180.0;
  std::vector<std::string> turns;
  for (const auto& p : outcome.motion.parameters)
    if (p.name.ends_with("TibialTorsion") && std::abs(p.value) > kSeen_rad)
      turns.push_back(fmt::format("{} {:.1f} deg", p.name, p.value * 180.0 / std::numbers::pi));
  if (!turns.empty())
    outcome.warnings.push_back(
        fmt::format("Knee rotation of a static trial contains the tibia's torsion, that of a walk does not: "
                    "beside a walk "
                    "it jumps by {}.",
                    fmt::join(turns, ", ")));
}

// What nobody stated of the static trial.
void note_choices(const analysis::SegmentDefinition& definition, SegmentsOutcome& outcome) {
  for (const auto& used : outcome.motion.parameters) {
    const auto p =
        std::ranges::find(definition.parameters, used.name, &analysis::SegmentDefinition::Parameter::name);
    if (!used.assumed || p == definition.parameters.end() || p->choices.empty()) continue;
    outcome.warnings.push_back(fmt::format(
        "{} is assumed to be {:g}: no file tells; --subject {}={:g} is the other.", used.name, used.value,
        used.name, p->choices.front() == used.value ? p->choices.back() : p->choices.front()));
  }
}

void find_cross_talk(const analysis::SegmentDefinition& definition, SegmentsOutcome& outcome) {
  for (const auto& series : outcome.motion.angles) {
    const auto a =
        std::ranges::find(definition.angles, series.name, &analysis::SegmentDefinition::Angle::name);
    if (a == definition.angles.end() || !a->cross_talk) continue;
    const auto found = analysis::find_cross_talk(series);
    if (!found) continue;
    outcome.cross_talk.emplace_back(series.name, *found);
    if (found->suspicious()) outcome.warnings.push_back(found->sentence(series.name));
  }
}

Status find_loads(const SegmentsJob& job, const analysis::SegmentDefinition& definition,
                  const Recording& recording, const analysis::SegmentInput& input,
                  const analysis::SegmentOptions& options, SegmentsOutcome& outcome) {
  const auto& plates = recording.plates;
  if (!plates || input.static_trial == input.markers) return {};
  auto loads = analysis::find_joint_loads(definition, input, *plates,
                                          {.segments = options, .refits = job.refits, .seed = job.seed});
  if (!loads) return fail_at(job.input.string(), loads.error());
  outcome.loads = std::move(*loads);
  std::ranges::copy(outcome.loads.warnings, std::back_inserter(outcome.warnings));
  return {};
}

Result<Staging> stage(const SegmentsJob& job) {
  if (job.output.empty()) return Staging::create({}, job, files_of(job));
  return Staging::create_in(
      job.output,
      {"angles.mot", "angles_sd.sto", "angles.csv", "centres.csv", "segments.c3d", "segments.json"}, job,
      files_of(job));
}

/// The static trial by the names of its markers, and against the recording, before anything is built on it.
Status judge_static(const SegmentsJob& job, const Files& files, SegmentsOutcome& outcome) {
  if (job.static_trial.empty()) return {};
  const auto& still = files.static_trial ? files.static_trial->markers : files.recording.trial.markers;
  std::vector<const data::Trajectories*> movements;
  if (files.static_trial) movements.push_back(&files.recording.trial.markers);
  auto judgement = judge_static_trial(job.static_trial.filename().string(),
                                      motion::body_of_names(still.names), still, movements, outcome);
  if (!judgement) return std::unexpected(judgement.error());
  outcome.static_trial = std::move(*judgement);
  return {};
}

GaitDrawingJob drawing_of(const SegmentsJob& job) {
  GaitDrawingJob out;
  static_cast<JobSettings&>(out) = job;
  static_cast<GaitOutputs&>(out) = job;
  out.refits = job.refits;
  out.level = job.level;
  out.noise_sd_m = job.noise_sd_m;
  return out;
}

// Angles and values over the cycle, and what else of them is drawn.
Result<std::vector<ResultFile>> draw_walking(const SegmentsJob& job, const Recording& recording,
                                             GaitDrawing& drawing, Staging& staging,
                                             SegmentsOutcome& outcome) {
  if (auto s = drawing.find_walking(recording); !s) {
    if (s.error().code == Code::usage || job.output.empty()) return std::unexpected(s.error());
    outcome.warnings.push_back("walking is not drawn: " + s.error().message);
    return std::vector<ResultFile>();
  }
  outcome.gait = drawing.gait();
  std::ranges::copy(outcome.gait->notes, std::back_inserter(outcome.warnings));
  std::vector<SheetInput> inputs;
  SeriesList list = series_of(outcome.motion);
  for (const auto& series : outcome.loads.series)
    if (series.name.ends_with("Moment") || series.name.ends_with("Power")) list.push_back(&series);
  for (const auto& series : cycle_series(list, outcome.motion.time))
    add_series(series, outcome.gait->cycles, "", inputs);
  std::vector<data::CycleCurves> curves;
  for (const auto& input : inputs) curves.push_back(input.curves);
  // Moments that the recording holds give way to those that were computed.
  Recording others = recording;
  if (!outcome.loads.series.empty()) others.trial.channels = {};
  add_recorded_kinetics(others, *outcome.gait, inputs);
  return drawing.draw(job.input, recording.trial, curves, inputs,
                      {.angles_from = outcome.title, .inputs = outcome.inputs}, staging, outcome);
}

Status write_all(const SegmentsJob& job, const Files& files, std::optional<GaitDrawing>& drawing,
                 Staging& staging, SegmentsOutcome& outcome) {
  staging.add_inputs(outcome.inputs);
  internal::SegmentTables tables;
  std::vector<ResultFile> made;
  if (!job.output.empty()) {
    tables = internal::tables_of(outcome, files.recording.trial);
    auto listed = internal::list_files(job, tables, outcome, staging);
    if (!listed) return std::unexpected(listed.error());
    made = std::move(*listed);
  }
  if (drawing) {
    auto drawn = draw_walking(job, files.recording, *drawing, staging, outcome);
    if (!drawn) return fail_at(job.input.string(), drawn.error());
    std::ranges::move(*drawn, std::back_inserter(made));
  }
  auto written = write_results(staging, made, job.progress, "the segments", tables.set);
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return {};
}

}  // namespace

Result<SegmentsOutcome> run_segments(const SegmentsJob& job) {
  if (auto s = job.RecordingOptions::check(); !s) return std::unexpected(s.error());
  if (auto s = check_folder(job.output, "angles are"); !s) return std::unexpected(s.error());
  const auto definition = find_definition(job.definition);
  if (!definition) return std::unexpected(definition.error());
  auto staging = stage(job);
  if (!staging) return std::unexpected(staging.error());
  std::optional<GaitDrawing> drawing;
  if (auto walking = drawing_of(job); walking.wanted()) {
    auto begun = GaitDrawing::begin(std::move(walking), *staging);
    if (!begun) return std::unexpected(begun.error());
    drawing.emplace(std::move(*begun));
  } else if (auto s = job.gait.check_idle(); !s) {
    return std::unexpected(s.error());
  }
  if (job.report.empty() && job.level != SegmentsJob{}.level)
    return fail(Code::usage, "--level is of the measures of a gait report; need --report FILE.html too");
  SegmentsOutcome outcome;
  outcome.title = definition->title.empty() ? job.definition : definition->title;
  auto files = read_files(job, outcome);
  if (!files) return std::unexpected(files.error());
  if (auto s = judge_static(job, *files, outcome); !s) return std::unexpected(s.error());
  const auto up = up_of(job, files->recording.trial);
  analysis::SegmentInput input;
  join_points(job, *definition, *files, input, outcome.warnings);
  if (auto s = find_values(job, *definition, *files, input, outcome); !s) return std::unexpected(s.error());
  const analysis::SegmentOptions options{.noise_sd_m = job.noise_sd_m, .up = up, .threads = job.threads};
  auto motion = analysis::compute_segments(*definition, input, options);
  if (!motion) return fail_at(job.input.string(), motion.error());
  outcome.motion = std::move(*motion);
  if (outcome.motion.noise) {
    input.noise = &*outcome.motion.noise;
    std::ranges::move(input.noise->sentences(), std::back_inserter(outcome.warnings));
  }
  auto comparison = compare_outputs(*definition, input, options, outcome.motion, files->recording.trial);
  if (!comparison) return fail_at(job.input.string(), comparison.error());
  outcome.comparison = std::move(*comparison);
  if (auto s = find_loads(job, *definition, files->recording, input, options, outcome); !s)
    return std::unexpected(s.error());
  std::ranges::copy(outcome.motion.warnings, std::back_inserter(outcome.warnings));
  std::ranges::move(outcome.comparison.findings(), std::back_inserter(outcome.warnings));
  note_static_angles(*files, outcome);
  if (input.static_trial != nullptr) note_choices(*definition, outcome);
  find_cross_talk(*definition, outcome);
  if (auto s = write_all(job, *files, drawing, *staging, outcome); !s) return std::unexpected(s.error());
  return outcome;
}

}  // namespace kinemark::pipeline
