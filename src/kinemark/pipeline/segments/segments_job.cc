// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/segments_job.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/gait/sheet_inputs.h"
#include "kinemark/pipeline/segments/definition_file.h"
#include "kinemark/pipeline/segments/segment_tables.h"
#include "kinemark/pipeline/segments/subject_input.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

/// All recordings that are read.
struct Files {
  Recording recording;
  std::optional<Recording> static_trial;  // none: there is none, or it is the recording
  bool static_is_recording = false;
  std::vector<std::pair<std::string, Recording>> trials;  // in the order of the job
};

/// A recording beside the one that is measured is used as that one is, but whole and by its own journal.
RecordingOptions beside_options(const SegmentsJob& job) {
  RecordingOptions out;
  out.rate_hz = job.rate_hz;
  out.unit = job.unit;
  if (job.edits.empty() || job.edits == io::kEditsNone) out.edits = io::kEditsNone;
  out.axes = job.axes;
  return out;
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) && !error;
}

/// @param options  those of the recording, or beside_options()
Result<Recording> read_one(const SegmentsJob& job, const fs::path& path, const RecordingOptions& options,
                           SegmentsOutcome& outcome) {
  const bool alone = job.static_trial.empty() && job.trials.empty();
  // Static trials and pairs are judged by gates of their own.
  const bool judged =
      path == job.static_trial || (!job.static_trial.empty() && same_file(path, job.static_trial));
  auto read = open_recording({.path = path,
                              .rate = alone ? io::RateRule::given : io::RateRule::where_needed,
                              .needs_samples = true,
                              .record = true,
                              .plates = path == job.input,
                              .forces = path == job.input ? job.forces : fs::path{},
                              .facts = {.sides = !judged, .pairs = false},
                              .one_time = true,
                              .force = job.force,
                              .seed = job.seed,
                              .threads = job.threads},
                             options);
  if (!read) return std::unexpected(read.error());
  outcome.inputs.push_back(std::move(read->file));
  if (read->journal.file) outcome.inputs.push_back(*read->journal.file);
  std::ranges::move(read->forces, std::back_inserter(outcome.inputs));
  return read;
}

/// Every file that the job reads, but those that it finds beside and in others.
std::vector<fs::path> files_of(const SegmentsJob& job) {
  auto files = pipeline::files_of(job.input, job);
  std::ranges::move(pipeline::files_of(job.gait), std::back_inserter(files));
  files.insert(files.end(), {job.definition, job.static_trial, job.vsk, job.forces});
  if (!job.static_trial.empty()) files.push_back(io::edits_of(job.static_trial));
  for (const auto& text : job.trials) {
    files.emplace_back(text.substr(text.find('=') + 1));
    files.push_back(io::edits_of(files.back()));
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
    auto trial = read_one(job, job.static_trial, beside_options(job), outcome);
    if (!trial) return std::unexpected(trial.error());
    out.static_trial = std::move(*trial);
  }
  for (const auto& text : job.trials) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      return fail(Code::usage, fmt::format("'{}' is not NAME=FILE", text));
    auto trial = read_one(job, text.substr(equals + 1), beside_options(job), outcome);
    if (!trial) return std::unexpected(trial.error());
    out.trials.emplace_back(text.substr(0, equals), std::move(*trial));
  }
  return out;
}

/// Measures of the subject that the job names, and those of its file.
Status read_values(const SegmentsJob& job, const analysis::SegmentDefinition& definition,
                   workflow::SegmentsOptions& options, SegmentsOutcome& outcome) {
  for (const auto& text : job.subject) {
    auto value = parse_subject_value(text, definition);
    if (!value) return std::unexpected(value.error());
    options.given.push_back(std::move(*value));
  }
  if (job.vsk.empty()) return {};
  auto values = read_subject_file(job.vsk, definition);
  if (!values) return std::unexpected(values.error());
  outcome.inputs.push_back({.role = "subject", .path = job.vsk.string()});
  options.known = std::move(*values);
  return {};
}

workflow::SegmentsOptions options_of(const SegmentsJob& job, const Files& files) {
  workflow::SegmentsOptions out;
  if (files.static_is_recording) out.static_trial = &files.recording;
  if (files.static_trial) out.static_trial = &*files.static_trial;
  for (const auto& [name, trial] : files.trials) out.trials.push_back({name, &trial});
  out.name = job.input.filename().string();
  out.where = job.input.string();
  out.static_name = job.static_trial.filename().string();
  out.noise_sd_m = job.noise_sd_m;
  out.drop_doubtful = job.drops_doubtful(true);
  out.refits = job.refits;
  out.seed = job.seed;
  out.threads = job.threads;
  return out;
}

/// What there is to say of a recording: by its reader, on what was done to it, by screening.
void say(const Recording& read, std::vector<std::string>& screening, std::vector<std::string>& warnings) {
  std::ranges::copy(read.trial.warnings, std::back_inserter(warnings));
  std::ranges::copy(read.notes, std::back_inserter(warnings));
  std::ranges::move(screening, std::back_inserter(warnings));
}

/// What is found, behind what there is to say of each recording.
void take(workflow::SegmentsFound found, const Files& files, SegmentsOutcome& outcome) {
  auto screening = std::exchange(found.screening, {});
  auto remarks = std::exchange(found.remarks, {});
  static_cast<workflow::SegmentsFound&>(outcome) = std::move(found);
  say(files.recording, screening.recording, outcome.warnings);
  if (files.static_trial) say(*files.static_trial, screening.static_trial, outcome.warnings);
  for (std::size_t i = 0; i < files.trials.size(); ++i)
    say(files.trials[i].second, screening.trials[i], outcome.warnings);
  std::ranges::move(remarks.warnings, std::back_inserter(outcome.warnings));
  outcome.gates = std::move(remarks.gates);
}

/// Read, compute.
Status find(const SegmentsJob& job, const analysis::SegmentDefinition& definition, SegmentsOutcome& outcome) {
  auto files = read_files(job, outcome);
  if (!files) return std::unexpected(files.error());
  auto options = options_of(job, *files);
  if (auto s = read_values(job, definition, options, outcome); !s) return s;
  auto found = workflow::segments(definition, files->recording, options);
  if (!found) return std::unexpected(found.error());
  take(std::move(*found), *files, outcome);
  return {};
}

Result<Staging> stage(const SegmentsJob& job) {
  if (job.output.empty()) return Staging::create({}, job, files_of(job));
  return Staging::create_in(
      job.output,
      {"angles.mot", "angles_sd.sto", "angles.csv", "centres.csv", "segments.c3d", "segments.json"}, job,
      files_of(job));
}

/// What the files of the folder are made from, until they are written.
struct SegmentTables {
  SeriesList angles, loads;
  data::Trial points, whole;
  std::string set;  ///< its name
};

/// The outcome must outlive them.
SegmentTables tables_of(const SegmentsOutcome& outcome, const data::Trial& recording) {
  const auto& motion = outcome.motion;
  SegmentTables out{.angles = series_of(motion),
                    .loads = series_of(outcome.loads),
                    .points = points_trial(motion, recording),
                    .whole = trial_with(motion, outcome.loads, recording),
                    .set = ""};
  SetDigest digest;
  digest.add("segments").add(outcome.inputs).add(series_csv(out.angles, motion.time));
  if (!out.loads.empty()) digest.add(series_csv(out.loads, motion.time));
  out.set = digest.hex();
  return out;
}

/// All files; those of loads are added to `staging`, which has the others. They need tables and outcome
/// until they are written.
Result<std::vector<ResultFile>> list_files(const SegmentsJob& job, const SegmentTables& tables,
                                           const SegmentsOutcome& outcome, Staging& staging) {
  const auto& [angles, loads, points, whole, set] = tables;
  const auto& time = outcome.motion.time;
  const auto target = [&job](const char* name) { return job.output / name; };
  std::vector<ResultFile> made{
      table_file(target("angles.mot"), [&] { return series_table(angles, time, "angles"); }),
      table_file(target("angles_sd.sto"), [&] { return deviations_table(angles, time, "angles_sd"); }),
      text_file(target("angles.csv"), [&] { return series_csv(angles, time); }),
      marker_file(target("centres.csv"), points),
      marker_file(target("segments.c3d"), whole),
      json_file(target("segments.json"), [json = segments_outcome_json(outcome)] { return json; })};
  if (loads.empty()) return made;
  if (auto s = staging.add_in(job.output, {"loads.sto", "loads_sd.sto", "loads.csv"}); !s)
    return std::unexpected(s.error());
  made.push_back(table_file(target("loads.sto"), [&] { return series_table(loads, time, "loads"); }));
  made.push_back(
      table_file(target("loads_sd.sto"), [&] { return deviations_table(loads, time, "loads_sd"); }));
  made.push_back(text_file(target("loads.csv"), [&] { return series_csv(loads, time); }));
  return made;
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
Result<std::vector<ResultFile>> draw_walking(const SegmentsJob& job, GaitDrawing& drawing, Staging& staging,
                                             SegmentsOutcome& outcome) {
  const auto& recording = outcome.used;
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
  data::Recording others = recording;
  if (!outcome.loads.series.empty()) others.trial.channels = {};
  add_recorded_kinetics(others, *outcome.gait, inputs);
  return drawing.draw(job.input, recording.trial, curves, inputs,
                      {.angles_from = outcome.title, .inputs = outcome.inputs}, staging, outcome);
}

Status write_all(const SegmentsJob& job, std::optional<GaitDrawing>& drawing, Staging& staging,
                 SegmentsOutcome& outcome) {
  staging.add_inputs(outcome.inputs);
  SegmentTables tables;
  std::vector<ResultFile> made;
  if (!job.output.empty()) {
    tables = tables_of(outcome, outcome.used.trial);
    auto listed = list_files(job, tables, outcome, staging);
    if (!listed) return std::unexpected(listed.error());
    made = std::move(*listed);
  }
  if (drawing) {
    auto drawn = draw_walking(job, *drawing, staging, outcome);
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
  if (auto s = find(job, *definition, outcome); !s) return std::unexpected(s.error());
  if (auto s = write_all(job, drawing, *staging, outcome); !s) return std::unexpected(s.error());
  return outcome;
}

}  // namespace kinemark::pipeline
