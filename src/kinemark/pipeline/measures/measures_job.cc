// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measures_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <memory>
#include <set>
#include <utility>

#include "kinemark/io/file.h"
#include "kinemark/pipeline/files/edit_input.h"
#include "kinemark/pipeline/files/marker_input.h"
#include "kinemark/pipeline/files/marker_screening.h"
#include "kinemark/pipeline/files/page_file.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/gait/sheet_inputs.h"
#include "kinemark/pipeline/measures/gait_cycles.h"
#include "kinemark/pipeline/measures/gait_drawing.h"
#include "kinemark/pipeline/measures/measure_figures.h"
#include "kinemark/pipeline/measures/measure_regions.h"
#include "kinemark/pipeline/measures/measures_asked.h"
#include "kinemark/pipeline/measures/measures_page.h"
#include "kinemark/pipeline/measures/measures_table.h"
#include "kinemark/stages/analysis/path/path_measures.h"

namespace kinemark::pipeline {
namespace {

Status check_output(const std::filesystem::path& output) {
  const auto ending = ending_of(output);
  if (output.empty() || ending == ".csv" || ending == ".json") return {};
  return fail(Code::usage, fmt::format("{}: measures are written as .csv or .json", output.string()));
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
  if (auto s = leave_out_defects(trial, job.keep_defects, outcome.warnings); !s)
    return std::unexpected(s.error());
  return regions_of(job, trial, std::move(taken->regions));
}

// Names of files that are told apart by more than the case of their letters.
void make_unique(std::vector<NamedFigure>& figures) {
  std::set<std::string> seen;
  for (auto& figure : figures) {
    std::string name = figure.name;
    const auto is_new = [&seen](std::string text) {
      std::ranges::transform(text, text.begin(),
                             [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      return seen.insert(std::move(text)).second;
    };
    for (int number = 2; !is_new(name); ++number) name = fmt::format("{}_{}", figure.name, number);
    figure.name = std::move(name);
  }
}

Status write_figures(const MeasuresJob& job, const std::vector<std::string>& formats,
                     const std::vector<NamedFigure>& figures, const GaitReport* gait,
                     MeasuresOutcome& outcome) {
  std::vector<std::string> names;
  std::vector<ResultFile> files;
  for (const auto& figure : figures)
    for (const auto& format : formats) {
      names.push_back(figure.name + "." + format);
      files.push_back(
          {.target = job.figures / names.back(),
           .write = [&figure, format](const std::filesystem::path& staged, const std::string&) -> Status {
             const auto content = figure_file(figure.figure, format);
             if (!content) return std::unexpected(content.error());
             return io::write_text(staged, *content, false);
           }});
    }
  if (gait != nullptr) {
    std::ranges::move(gait_report_files(*gait, formats), std::back_inserter(names));
    std::ranges::move(gait_report_results(*gait, job.figures, formats), std::back_inserter(files));
  }
  auto staging = Staging::create_in(job.figures, names, job.force, {job.input, job.edits});
  if (!staging) return std::unexpected(staging.error());
  auto written = write_results(*staging, files, {}, "the figures");
  if (!written) return std::unexpected(written.error());
  std::ranges::move(*written, std::back_inserter(outcome.written));
  return {};
}

// What a page of walking alone says besides its sheet.
GaitPageFacts page_facts(const MeasuresJob& job, const MeasuresOutcome& outcome) {
  return {.angles_from = job.gait.angles.empty() ? "outputs of a model that the recording holds"
                                                 : job.gait.angles.filename().string(),
          .command_line = job.command_line,
          .inputs = {outcome.input},
          .warnings = outcome.warnings};
}

// The table and `files` with it, the figures, the page: what of them is asked for.
Status write_all(const MeasuresJob& job, const std::vector<std::string>& formats,
                 const std::vector<analysis::PathCurves>& curves, const GaitReport* gait,
                 std::vector<ResultFile> files, Staging& staging, PageFile& page, MeasuresOutcome& outcome) {
  std::vector<NamedFigure> figures;
  for (const auto& one : curves) std::ranges::move(measure_figures(one), std::back_inserter(figures));
  make_unique(figures);
  if (!job.output.empty())
    files.push_back(
        ending_of(job.output) == ".csv"
            ? text_file(job.output,
                        [&] { return measures_csv(outcome.measures, job.input.filename().string()); })
            : json_file(job.output, [&] { return measures_outcome_json(outcome); }));
  if (!files.empty()) {
    auto written = write_results(staging, files, {}, "the measures");
    if (!written) return std::unexpected(written.error());
    outcome.written = std::move(*written);
  }
  if (!job.figures.empty())
    if (auto s = write_figures(job, formats, figures, gait, outcome); !s) return s;
  if (!page.wanted()) return {};
  // Of walking alone; the page of measures shows others too.
  if (gait != nullptr && curves.empty() && outcome.measures.size() == outcome.gait->measures.size())
    return page.write(gait_report_page(*gait, page_facts(job, outcome)), outcome);
  if (gait != nullptr)
    for (const auto& [name, figure] : gait->figures) figures.push_back({.name = name, .figure = figure});
  return page.write(measures_page(job, outcome, figures), outcome);
}

// Steps and standing on plates.
Status measure_plates(const MeasuresJob& job, const AskedMeasures& asked, const data::Trial& trial,
                      MeasuresOutcome& outcome) {
  const auto plates = plates_of(job.input, trial);
  if (!plates) return fail(Code::bad_input, "there are no force plates whose forces can be read");
  auto options = asked.plates;
  options.regions = asked.path.regions;
  if (outcome.gait) options.events = outcome.gait->events;
  auto measured = analysis::measure_forces(*plates, options);
  if (!measured) return std::unexpected(measured.error());
  std::ranges::move(measured->measures, std::back_inserter(outcome.measures));
  std::ranges::move(measured->notes, std::back_inserter(outcome.warnings));
  return {};
}

// Electromyograms, where channels are named or known by their names.
Status measure_muscles(const MeasuresJob& job, const AskedMeasures& asked, const data::Trial& trial,
                       MeasuresOutcome& outcome) {
  auto measured = measure_emg_of(trial, job.emg, asked.path.regions, asked.emg);
  if (!measured) return std::unexpected(measured.error());
  std::ranges::copy(measured->measures, std::back_inserter(outcome.measures));
  std::ranges::copy(measured->notes, std::back_inserter(outcome.warnings));
  outcome.emg = std::move(*measured);
  return {};
}

// A failure of what was asked for by name ends the job where nothing else is measured, and is told else; what
// was not asked for is simply not there.
Status take_failure(const Status& status, const char* what, bool by_name, bool needed,
                    MeasuresOutcome& outcome) {
  if (status || !by_name) return {};
  if (needed || status.error().code == Code::usage) return status;
  outcome.warnings.push_back(fmt::format("{} are not measured: {}", what, status.error().message));
  return {};
}

// Walking, plates, EMG, then paths; what fails is reported where something else is measured.
Status measure_all(const MeasuresJob& job, const AskedMeasures& asked, const data::Trial& trial,
                   std::vector<analysis::PathCurves>& curves, MeasuresOutcome& outcome) {
  const bool events_needed =
      !job.gait.write_events.empty() || !job.gait.write_cycles.empty() || !job.emg.write_cycles.empty();
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
  const bool others = asked.paths || asked.by_name;
  if (asked.forces)
    if (auto s = take_failure(measure_plates(job, asked, trial, outcome), "Force plates",
                              asked.forces_by_name, !others && !asked.muscles_by_name, outcome);
        !s)
      return s;
  if (asked.muscles)
    if (auto s = take_failure(
            measure_muscles(job, asked, trial, outcome), "EMG", asked.muscles_by_name,
            (!others && outcome.measures.empty()) || !job.emg.write.empty() || !job.emg.write_cycles.empty(),
            outcome);
        !s)
      return s;
  if (!asked.paths) return {};
  auto measured = analysis::measure_paths(trial.markers, asked.path);
  if (!measured) return std::unexpected(measured.error());
  if (measured->measures.empty() && outcome.measures.empty())
    return fail(Code::bad_input,
                fmt::format("nothing can be measured: {}",
                            measured->warnings.empty() ? "no measure applies" : measured->warnings.front()));
  curves = std::move(measured->curves);
  std::ranges::move(measured->measures, std::back_inserter(outcome.measures));
  std::ranges::move(measured->warnings, std::back_inserter(outcome.warnings));
  return {};
}

// Tables of events and cycles, or the recording with its events.
struct GaitFiles {
  std::optional<data::Trial> recorded;
  std::vector<data::CycleCurves> curves;
};

Result<std::vector<ResultFile>> gait_files(const MeasuresJob& job, const data::Trial& trial,
                                           const MeasuresOutcome& outcome, GaitFiles& of) {
  std::vector<ResultFile> out;
  const auto name = job.input.filename().string();
  if (of.recorded && outcome.gait) {
    of.recorded = with_events(std::move(*of.recorded), *outcome.gait);
    out.push_back(marker_file(job.gait.write_events, *of.recorded));
  } else if (!job.gait.write_events.empty()) {
    out.push_back(text_file(job.gait.write_events,
                            [&, name] { return events_csv(*outcome.gait, trial.markers.time, name); }));
  }
  const bool per_cent = !job.emg.maximum.empty();
  if (!job.emg.write.empty()) {
    const auto table = [&, per_cent] { return envelope_table(trial, *outcome.emg, per_cent); };
    out.push_back(ending_of(job.emg.write) == ".csv"
                      ? text_file(job.emg.write, [table] { return envelope_csv(table()); })
                      : table_file(job.emg.write, table));
  }
  if (!job.emg.write_cycles.empty())
    out.push_back(text_file(job.emg.write_cycles, [&, name, per_cent] {
      return curves_csv(envelope_cycles(trial, *outcome.emg, outcome.gait->cycles, per_cent), name);
    }));
  if (job.gait.write_cycles.empty()) return out;
  auto cut = gait_curves(trial, outcome.gait->cycles, job.gait.angles);
  if (!cut) return std::unexpected(cut.error());
  of.curves = std::move(*cut);
  out.push_back(text_file(job.gait.write_cycles, [&, name] { return curves_csv(of.curves, name); }));
  return out;
}

// Walking drawn, where there is some; what cannot be drawn is told.
Result<std::unique_ptr<GaitReport>> draw_walking(const MeasuresJob& job, const data::Trial& trial,
                                                 const GaitNorms& norms, MeasuresOutcome& outcome) {
  if ((job.figures.empty() && job.report.empty()) || !outcome.gait) return nullptr;
  std::vector<SheetInput> inputs;
  if (const auto curves = gait_curves(trial, outcome.gait->cycles, job.gait.angles))
    add_curves(*curves, inputs);
  else if (!job.gait.angles.empty())
    return std::unexpected(curves.error());
  else if (job.gait.wanted() || !job.measures.empty())
    outcome.warnings.push_back("no angles are drawn: " + curves.error().message);
  add_recorded_kinetics(job.input, trial, *outcome.gait, inputs);
  if (inputs.empty() && !job.gait.wanted() && job.measures.empty()) return nullptr;
  auto report = make_gait_report(job.input.filename().string(), inputs, *outcome.gait, norms,
                                 job.gait.sheet.angle_angle);
  std::ranges::copy(report->sheet.remarks, std::back_inserter(outcome.warnings));
  return report;
}

}  // namespace

Result<MeasuresOutcome> run_measures(const MeasuresJob& job) {
  if (auto s = check_output(job.output); !s) return std::unexpected(s.error());
  if (auto s = job.selection.check(); !s) return std::unexpected(s.error());
  auto asked = asked_measures(job);
  if (!asked) return std::unexpected(asked.error());
  const auto formats = parse_figure_formats(job.figure_formats);
  if (!formats) return std::unexpected(formats.error());
  std::vector<std::filesystem::path> targets;
  for (const auto& path :
       {job.output, job.gait.write_events, job.gait.write_cycles, job.emg.write, job.emg.write_cycles})
    if (!path.empty()) targets.push_back(path);
  auto read = job.gait.sheet.norms;
  const auto norms = read_gait_norms(read);
  if (!norms) return std::unexpected(norms.error());
  for (const auto& path : {job.input, job.edits, job.gait.angles}) read.push_back(path);
  auto staging = Staging::create(targets, job.force, read);
  if (!staging) return std::unexpected(staging.error());
  auto page = PageFile::begin(job.report, {job.input, job.edits, job.output}, job.force);
  if (!page) return std::unexpected(page.error());
  auto input =
      read_marker_input({.path = job.input, .rate_hz = job.rate_hz, .needs_samples = true, .record = true});
  if (!input) return std::unexpected(input.error());
  MeasuresOutcome outcome;
  outcome.input = std::move(input->file);
  outcome.warnings = std::move(input->trial.warnings);
  const std::string name = job.input.string();
  auto& trial = input->trial;
  GaitFiles gait;
  if (ending_of(job.gait.write_events) == ".c3d") gait.recorded = trial;
  auto regions = prepare(job, trial, outcome);
  if (!regions) return fail_at(name, regions.error());
  asked->path.regions = asked->gait.regions = std::move(*regions);
  std::vector<analysis::PathCurves> curves;
  if (auto s = measure_all(job, *asked, trial, curves, outcome); !s) return fail_at(name, s.error());
  auto files = gait_files(job, trial, outcome, gait);
  if (!files) return fail_at(name, files.error());
  const auto report = draw_walking(job, trial, *norms, outcome);
  if (!report) return fail_at(name, report.error());
  if (auto s = write_all(job, *formats, curves, report->get(), std::move(*files), *staging, *page, outcome);
      !s)
    return std::unexpected(s.error());
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
