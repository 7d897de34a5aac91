// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/around_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/core/version.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/nwb/neural_file.h"
#include "kinemark/io/nwb/nwb_tables.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/measures/around_table.h"
#include "kinemark/pipeline/measures/measures_job.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"
#include "kinemark/workflow/around/curves.h"
#include "kinemark/workflow/clean/clean.h"
#include "kinemark/workflow/measures/measure.h"

namespace kinemark::pipeline {
namespace {

bool is_motion(const std::filesystem::path& path) {
  const auto ending = ending_of(path);
  return ending == ".mot" || ending == ".sto";
}

/// The file with the units.
Result<std::filesystem::path> spikes_file(const AroundJob& job) {
  if (!job.spikes.empty()) return job.spikes;
  if (ending_of(job.input) == ".nwb") return job.input;
  return fail(Code::usage, fmt::format("{} holds no spikes; --spikes FILE.nwb names a file with units on its "
                                       "clock",
                                       job.input.string()));
}

Result<workflow::MovementSession> read_motion(const AroundJob& job, AroundOutcome& out) {
  if (workflow::wants_movements(job))
    return fail(Code::usage, fmt::format("--around movement: starts are those of markers; {} is a motion",
                                         job.input.string()));
  auto table = io::read_table(job.input);
  if (!table) return std::unexpected(table.error());
  auto record = io::record_input("motion", job.input);
  if (!record) return std::unexpected(record.error());
  out.inputs.push_back(std::move(*record));
  std::ranges::move(table->warnings, std::back_inserter(out.warnings));
  workflow::MovementSession session;
  session.curves = workflow::curves_of(*table, io::angles_are_degrees(*table));
  session.span = workflow::span_of(session.curves);
  return session;
}

/// Starts of the markers' own movements, marker by marker.
Result<std::vector<workflow::NamedEvents>> movement_starts(const AroundJob& job, data::Recording recording,
                                                           std::vector<std::string>& warnings) {
  workflow::MeasureOptions options;
  options.measures = {"path_length"};  // one that is quick: the starts alone are wanted
  options.refits = job.refits;
  options.level = job.level;
  options.noise_sd_m = job.noise_sd_m;
  options.seed = job.seed;
  options.threads = job.threads;
  options.keep_doubtful = !job.drops_doubtful(true);
  options.needs.events = options.needs.own_movements = true;
  const auto found = workflow::measure(std::move(recording), options);
  if (!found) return std::unexpected(found.error());
  std::ranges::copy(found->remarks.warnings, std::back_inserter(warnings));
  std::vector<workflow::NamedEvents> out;
  for (const auto& rhythm : found->rhythms) {
    const auto label = analysis::to_string(analysis::PathEventKind::movement_start);
    workflow::NamedEvents own{.name = fmt::format("{} {}", rhythm.subject, label), .times_s = {}};
    for (const auto& event : rhythm.events)
      if (event.kind == analysis::PathEventKind::movement_start) own.times_s.push_back(event.time_s);
    if (!own.times_s.empty()) out.push_back(std::move(own));
  }
  return out;
}

Result<workflow::MovementSession> read_markers(const AroundJob& job, AroundOutcome& out) {
  const RecordingSource source{.path = job.input,
                               .needs_samples = true,
                               .record = true,
                               .force = job.force,
                               .seed = job.seed,
                               .threads = job.threads};
  auto recording = open_recording(source, job);
  if (!recording) return std::unexpected(recording.error());
  out.inputs.push_back(recording->file);
  if (recording->journal.file) out.inputs.push_back(*recording->journal.file);
  std::ranges::copy(recording->trial.warnings, std::back_inserter(out.warnings));
  std::ranges::copy(recording->notes, std::back_inserter(out.warnings));
  workflow::MovementSession session;
  session.events = recording->trial.events;
  const auto& time = recording->trial.markers.time;
  session.span = {.start_s = time.t0_s, .end_s = time.time_s(time.frames - 1)};
  if (workflow::wants_movements(job)) {
    auto starts = movement_starts(job, *recording, out.warnings);
    if (!starts) return fail_at(job.input.string(), starts.error());
    session.movements = std::move(*starts);
    return session;
  }
  auto repaired = workflow::repair(std::move(static_cast<data::Recording&>(*recording)),
                                   {.reject_doubtful = job.drops_doubtful(true),
                                    .gaps = {.method = trajectory::GapMethod::none},
                                    .seed = job.seed,
                                    .threads = job.threads});
  if (!repaired) return fail_at(job.input.string(), repaired.error());
  const auto& markers = repaired->recording.trial.markers;
  const auto smooth = trajectory::smooth(
      markers, {.noise_sd_m = job.noise_sd_m, .leave = repaired->apart.all(), .threads = job.threads});
  if (!smooth) out.warnings.push_back("no speeds: " + smooth.error().message);
  session.curves = workflow::curves_of(markers, smooth ? &smooth->derivatives : nullptr);
  return session;
}

ResultFile table_of(const AroundJob& job, const AroundOutcome& out) {
  const auto name = name_of_recording(job.input);
  const auto ending = ending_of(job.output);
  if (ending == ".csv")
    return text_file(job.output, [&out, &job, name] { return around_csv(out.curves, job, name); });
  if (ending == ".json") return json_file(job.output, [&out, &job] { return around_outcome_json(out, job); });
  io::NwbMetadata metadata{.session_description = "averages of a movement and spikes around events",
                           .version = std::string(kVersion),
                           .command = job.command_line,
                           .seed = job.seed};
  for (const auto& input : out.inputs) metadata.sources.push_back({input.path, input.bytes, input.hash});
  return {.target = job.output,
          .write = [&out, &job, name, metadata](const std::filesystem::path& staged,
                                                const std::string& set) -> Status {
            auto named = metadata;
            named.set = set;
            return io::write_nwb_tables(staged, std::vector{around_nwb(out.curves, job, name)}, named, false);
          }};
}

}  // namespace

std::vector<std::filesystem::path> files_of(const AroundJob& job) {
  auto out = is_motion(job.input) ? std::vector{job.input} : io::files_of(job.input, job.edits);
  out.push_back(job.spikes);
  return out;
}

Result<AroundOutcome> run_around(const AroundJob& job) {
  if (auto s = check_measures_output(job.output); !s) return std::unexpected(s.error());
  if (auto s = job.RecordingOptions::check(); !s) return std::unexpected(s.error());
  if (auto s = job.AroundChoice::check(); !s) return std::unexpected(s.error());
  const auto spikes = spikes_file(job);
  if (!spikes) return std::unexpected(spikes.error());
  std::vector<std::filesystem::path> targets;
  if (!job.output.empty()) targets.push_back(job.output);
  auto staging = Staging::create(targets, job, files_of(job));
  if (!staging) return std::unexpected(staging.error());
  auto neural = io::read_neural(*spikes);
  if (!neural) return std::unexpected(neural.error());
  AroundOutcome out;
  const auto session = is_motion(job.input) ? read_motion(job, out) : read_markers(job, out);
  if (!session) return std::unexpected(session.error());
  if (*spikes != job.input) {
    auto record = io::record_input("spikes", *spikes);
    if (!record) return std::unexpected(record.error());
    out.inputs.push_back(std::move(*record));
  }
  auto found = workflow::around(*session, std::move(*neural), job);
  if (!found) return fail_at(spikes->string(), found.error());
  out.curves = std::move(found->curves);
  std::ranges::move(found->remarks.warnings, std::back_inserter(out.warnings));
  staging->add_inputs(out.inputs);
  if (job.output.empty()) return out;
  auto written = write_results(*staging, {table_of(job, out)}, {}, "the averages");
  if (!written) return std::unexpected(written.error());
  out.written = std::move(*written);
  return out;
}

nlohmann::ordered_json around_outcome_json(const AroundOutcome& outcome, const AroundJob& job) {
  nlohmann::ordered_json out;
  out["inputs"] = nlohmann::ordered_json::array();
  for (const auto& input : outcome.inputs)
    out["inputs"].push_back({{"path", input.path}, {"bytes", input.bytes}, {input.hash_kind, input.hash}});
  out["around"] = around_json(outcome.curves, job);
  out["written"] = nlohmann::ordered_json::array();
  for (const auto& path : outcome.written) out["written"].push_back(path.string());
  out["warnings"] = outcome.warnings;
  return out;
}

}  // namespace kinemark::pipeline
