// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measures_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"
#include "kinemark/pipeline/files/edit_input.h"
#include "kinemark/pipeline/files/marker_input.h"
#include "kinemark/pipeline/files/marker_screening.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/measures/gait_cycles.h"
#include "kinemark/pipeline/measures/measure_regions.h"
#include "kinemark/pipeline/measures/measures_table.h"
#include "kinemark/stages/analysis/gait/spatiotemporal.h"
#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/path_measures.h"

namespace kinemark::pipeline {
namespace {

constexpr std::size_t kDefectsListed = 5;

Status check_output(const std::filesystem::path& output) {
  const auto ending = ending_of(output);
  if (output.empty() || ending == ".csv" || ending == ".json") return {};
  return fail(Code::usage, fmt::format("{}: measures are written as .csv or .json", output.string()));
}

// What the recorder made is no sample, what screening is sure of neither.
Status screen_trial(const MeasuresJob& job, data::Trial& trial, MeasuresOutcome& outcome) {
  const auto screening = screen_markers(
      trial,
      {.recorder_made = RecorderMade::mark, .find_defects = !job.keep_defects, .reject_defects = true});
  if (!screening) return std::unexpected(screening.error());
  const auto& sure = screening->sure;
  for (std::size_t i = 0; i < std::min(sure.size(), kDefectsListed); ++i)
    outcome.warnings.push_back("Left out: " + sentence_of(sure[i], trial.markers.time));
  if (sure.size() > kDefectsListed)
    outcome.warnings.push_back(
        fmt::format("Left out: {} more defects like these.", sure.size() - kDefectsListed));
  return {};
}

Result<std::vector<data::Region>> regions_of(const MeasuresJob& job, const data::Trial& trial,
                                             std::vector<data::Region> regions) {
  for (const auto& text : job.regions) {
    auto region = parse_region(text, trial.markers.time);
    if (!region) return std::unexpected(region.error());
    regions.push_back(std::move(*region));
  }
  for (const auto& label : job.between) {
    auto cycles = regions_between(label, trial);
    if (!cycles) return std::unexpected(cycles.error());
    std::ranges::move(*cycles, std::back_inserter(regions));
  }
  return regions;
}

// Edits, selection, screening; the regions to measure.
Result<std::vector<data::Region>> prepare(const MeasuresJob& job, data::Trial& trial,
                                          MeasuresOutcome& outcome) {
  auto taken = take_edits({.edits = job.edits,
                           .recording = job.input,
                           .force = job.force,
                           .seed = job.seed,
                           .threads = job.threads},
                          trial);
  if (!taken) return std::unexpected(taken.error());
  std::ranges::move(taken->notes, std::back_inserter(outcome.warnings));
  if (auto s = take_selection(job.selection, trial); !s) return std::unexpected(s.error());
  if (auto s = screen_trial(job, trial, outcome); !s) return std::unexpected(s.error());
  return regions_of(job, trial, std::move(taken->regions));
}

// What is asked of paths and of walking.
struct Asked {
  analysis::PathMeasureOptions path;
  analysis::GaitOptions gait;
  bool paths = true, walking = true;
  bool by_name = false;  // walking: what it lacks is to be told
};

bool is_path_measure(const std::string& id) {
  return std::ranges::any_of(analysis::path_definitions(), [&](const auto& d) { return d.what.id == id; });
}

Status unknown_measure(const std::string& id) {
  std::vector<std::string> known{"gait"};
  for (const auto& definition : analysis::path_definitions()) known.emplace_back(definition.what.id);
  for (const auto& definition : analysis::gait_definitions()) known.emplace_back(definition.what.id);
  const auto nearest = nearest_names(id, known);
  return fail(Code::usage, fmt::format("there is no measure '{}'{}; --list shows them all", id,
                                       nearest.empty() ? "" : fmt::format(" (nearest: {})", join(nearest))));
}

Result<Asked> read_asked(const MeasuresJob& job) {
  auto gait = gait_options(job.gait);
  if (!gait) return std::unexpected(gait.error());
  Asked out{.path = {.refits = job.refits,
                     .noise_sd_m = job.noise_sd_m,
                     .level = job.level,
                     .seed = job.seed,
                     .threads = job.threads},
            .gait = std::move(*gait)};
  bool all_of_walking = false;
  for (const auto& id : job.measures) {
    if (id == "gait")
      all_of_walking = true;
    else if (analysis::find_gait_definition(id) != nullptr)
      out.gait.measures.push_back(id);
    else if (is_path_measure(id))
      out.path.measures.push_back(id);
    else if (auto s = unknown_measure(id); !s)
      return std::unexpected(s.error());
  }
  out.by_name = all_of_walking || !out.gait.measures.empty() || job.gait.wanted();
  out.paths = job.measures.empty() || !out.path.measures.empty();
  out.walking = out.by_name || job.measures.empty();
  if (all_of_walking) out.gait.measures.clear();
  out.gait.refits = job.refits;
  out.gait.noise_sd_m = job.noise_sd_m;
  out.gait.level = job.level;
  out.gait.seed = job.seed;
  out.gait.threads = job.threads;
  return out;
}

// Walking, then paths; what fails is told where something else is measured.
Status measure_all(const MeasuresJob& job, const Asked& asked, const data::Trial& trial,
                   MeasuresOutcome& outcome) {
  const bool events_needed = !job.gait.write_events.empty() || !job.gait.write_cycles.empty();
  if (asked.walking) {
    auto gait = measure_gait(job.input, trial, asked.gait);
    if (gait) {
      std::ranges::copy(gait->notes, std::back_inserter(outcome.warnings));
      outcome.measures = gait->measures;
      outcome.gait = std::move(*gait);
    } else if (asked.by_name && (!asked.paths || events_needed || gait.error().code == Code::usage)) {
      return std::unexpected(gait.error());
    } else if (asked.by_name) {
      outcome.warnings.push_back("Walking is not measured: " + gait.error().message);
    }
  }
  if (!asked.paths) return {};
  auto measured = analysis::measure_paths(trial.markers, asked.path);
  if (!measured) return std::unexpected(measured.error());
  if (measured->measures.empty() && outcome.measures.empty())
    return fail(Code::bad_input,
                fmt::format("nothing can be measured: {}",
                            measured->warnings.empty() ? "no measure applies" : measured->warnings.front()));
  std::ranges::move(measured->measures, std::back_inserter(outcome.measures));
  std::ranges::move(measured->warnings, std::back_inserter(outcome.warnings));
  return {};
}

}  // namespace

Result<MeasuresOutcome> run_measures(const MeasuresJob& job) {
  if (auto s = check_output(job.output); !s) return std::unexpected(s.error());
  if (auto s = job.selection.check(); !s) return std::unexpected(s.error());
  auto asked = read_asked(job);
  if (!asked) return std::unexpected(asked.error());
  if (auto s = asked->path.check(); !s) return std::unexpected(s.error());
  std::vector<std::filesystem::path> targets;
  for (const auto& path : {job.output, job.gait.write_events, job.gait.write_cycles})
    if (!path.empty()) targets.push_back(path);
  auto staging = Staging::create(targets, job.force, {job.input, job.edits, job.gait.angles});
  if (!staging) return std::unexpected(staging.error());
  auto input =
      read_marker_input({.path = job.input, .rate_hz = job.rate_hz, .needs_samples = true, .record = true});
  if (!input) return std::unexpected(input.error());
  MeasuresOutcome outcome;
  outcome.input = std::move(input->file);
  outcome.warnings = std::move(input->trial.warnings);
  const std::string name = job.input.string();
  auto& trial = input->trial;
  std::optional<data::Trial> recorded;
  if (ending_of(job.gait.write_events) == ".c3d") recorded = trial;
  auto regions = prepare(job, trial, outcome);
  if (!regions) return fail_at(name, regions.error());
  asked->path.regions = asked->gait.regions = std::move(*regions);
  if (auto s = measure_all(job, *asked, trial, outcome); !s) return fail_at(name, s.error());

  std::vector<ResultFile> files;
  if (!job.output.empty())
    files.push_back(
        ending_of(job.output) == ".csv"
            ? text_file(job.output,
                        [&] { return measures_csv(outcome.measures, job.input.filename().string()); })
            : json_file(job.output, [&] { return measures_outcome_json(outcome); }));
  if (recorded && outcome.gait) recorded = with_events(std::move(*recorded), *outcome.gait);
  if (recorded)
    files.push_back(marker_file(job.gait.write_events, *recorded));
  else if (!job.gait.write_events.empty())
    files.push_back(text_file(job.gait.write_events, [&] {
      return events_csv(*outcome.gait, trial.markers.time, job.input.filename().string());
    }));
  std::vector<data::CycleCurves> curves;
  if (!job.gait.write_cycles.empty()) {
    auto cut = gait_curves(trial, outcome.gait->cycles, job.gait.angles);
    if (!cut) return fail_at(name, cut.error());
    curves = std::move(*cut);
    files.push_back(
        text_file(job.gait.write_cycles, [&] { return curves_csv(curves, job.input.filename().string()); }));
  }
  if (files.empty()) return outcome;
  auto written = write_results(*staging, files, {}, "the measures");
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return outcome;
}

nlohmann::ordered_json measures_outcome_json(const MeasuresOutcome& outcome) {
  nlohmann::ordered_json out;
  out["input"] = {{"path", outcome.input.path},
                  {"bytes", outcome.input.bytes},
                  {outcome.input.hash_kind, outcome.input.hash}};
  out["measures"] = measures_json(outcome.measures);
  if (outcome.gait) out["gait"] = gait_json(*outcome.gait);
  out["written"] = nlohmann::ordered_json::array();
  for (const auto& path : outcome.written) out["written"].push_back(path.string());
  out["warnings"] = outcome.warnings;
  return out;
}

}  // namespace kinemark::pipeline
