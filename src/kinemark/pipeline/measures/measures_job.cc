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

#include "kinemark/core/text.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/lost_parts.h"
#include "kinemark/io/nwb/neural_file.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/gait/sheet_inputs.h"
#include "kinemark/pipeline/measures/gait_drawing.h"
#include "kinemark/pipeline/measures/measure_figures.h"
#include "kinemark/pipeline/measures/measured_recording.h"
#include "kinemark/pipeline/measures/measures_nwb.h"
#include "kinemark/pipeline/measures/measures_table.h"
#include "kinemark/stages/report/neural_part.h"

namespace kinemark::pipeline {
namespace {

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

// The figures that are asked for, in a folder of their own.
Status add_figures(const MeasuresJob& job, const std::vector<std::string>& formats,
                   const std::vector<NamedFigure>& figures, const GaitReport* gait, Staging& staging,
                   std::vector<ResultFile>& files) {
  if (job.figures.empty()) return {};
  std::vector<std::string> names;
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
  return staging.add_in(job.figures, names);
}

// What a page of walking alone says besides its sheet.
GaitPageFacts page_facts(const MeasuresJob& job, const MeasuresOutcome& outcome) {
  return {.angles_from = job.gait.angles.empty() ? "outputs of a model that the recording holds"
                                                 : job.gait.angles.filename().string(),
          .command_line = job.command_line,
          .inputs = inputs_of(outcome),
          .warnings = outcome.warnings,
          .gates = outcome.gates};
}

// What lies beside the movements of paths; null: nothing, or what cannot be read, which a note of the trials
// says.
nlohmann::ordered_json lanes_of(const MeasuresJob& job, const TimeBase& time) {
  if (job.of != workflow::MeasuresOf::paths || ending_of(job.input) != ".nwb" || time.frames < 2)
    return nullptr;
  const auto neural = io::read_neural_lanes(job.input);
  return neural ? report::neural_json(*neural, time.t0_s, time.time_s(time.frames - 1)) : nullptr;
}

// The page of walking alone, or of measures, which shows others too.
std::string page_text(const MeasuresJob& job, const MeasuredRecording& measured,
                      std::vector<NamedFigure> figures, const GaitReport* gait) {
  const auto& outcome = measured.outcome;
  if (gait != nullptr && measured.curves.empty() && outcome.measures.size() == outcome.gait->measures.size())
    return gait_report_page(*gait, page_facts(job, outcome));
  if (gait != nullptr)
    for (const auto& [name, figure] : gait->figures) figures.push_back({.name = name, .figure = figure});
  return measures_page(job, outcome, figures, lanes_of(job, measured.recording.trial.markers.time));
}

// The table and `files` with it, the figures, the page: what of them is asked for.
Status write_all(const MeasuresJob& job, const std::vector<std::string>& formats, MeasuredRecording& measured,
                 const GaitReport* gait, std::vector<ResultFile> files, Staging& staging) {
  auto& outcome = measured.outcome;
  std::vector<NamedFigure> figures;
  for (const auto& one : measured.curves)
    std::ranges::move(measure_figures(one), std::back_inserter(figures));
  make_unique(figures);
  const auto ending = ending_of(job.output);
  if (ending == ".csv")
    files.push_back(text_file(job.output, [&] { return measures_csv(outcome.measures, measured.name); }));
  else if (ending == ".json")
    files.push_back(json_file(job.output, [&] { return measures_outcome_json(outcome); }));
  else if (!job.output.empty())
    files.push_back(nwb_file(
        job.output, {{.name = measured.name, .measures = outcome.measures, .events = measured.events}},
        inputs_of(outcome), job, measured.recording.trial.beside));
  if (auto lost = io::lost_beside(ending, measured.recording.trial.beside); !lost.empty() && !ending.empty())
    outcome.warnings.push_back(std::move(lost));
  if (auto s = add_figures(job, formats, figures, gait, staging, files); !s) return s;
  if (!job.report.empty())
    files.push_back(text_file(job.report, [&] { return page_text(job, measured, figures, gait); }));
  if (files.empty()) return {};
  auto written = write_results(staging, files, {}, "the measures");
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return {};
}

// Tables of events and cycles, or the recording with its events; envelopes.
Result<std::vector<ResultFile>> other_files(const MeasuresJob& job, MeasuredRecording& measured) {
  std::vector<ResultFile> out;
  const auto& events = measured.events;
  if (measured.recorded) {
    const bool several = std::ranges::any_of(
        events, [&](const EventRow& event) { return event.subject != events.front().subject; });
    if (several)
      return fail(
          Code::usage,
          fmt::format("{}: in a recording nothing tells the events of several markers apart; choose one "
                      "with --select, or write them as .csv",
                      job.gait.write_events.string()));
    measured.recorded = with_events(std::move(*measured.recorded), events);
    out.push_back(marker_file(job.gait.write_events, *measured.recorded));
  } else if (!job.gait.write_events.empty()) {
    out.push_back(
        text_file(job.gait.write_events, [&] { return events_csv(measured.events, measured.name); }));
  }
  const bool per_cent = !job.emg.maximum.empty();
  if (!job.emg.write.empty()) {
    const auto table = [&, per_cent] {
      return envelope_table(measured.recording.trial, *measured.outcome.emg, per_cent);
    };
    out.push_back(ending_of(job.emg.write) == ".csv"
                      ? text_file(job.emg.write, [table] { return envelope_csv(table()); })
                      : table_file(job.emg.write, table));
  }
  if (!job.emg.write_cycles.empty())
    out.push_back(text_file(job.emg.write_cycles, [&, per_cent, cycles = measured.outcome.gait->cycles] {
      return curves_csv(
          {{"", envelope_cycles(measured.recording.trial, *measured.outcome.emg, cycles, per_cent)}},
          measured.name);
    }));
  if (!job.gait.write_cycles.empty())
    out.push_back(
        text_file(job.gait.write_cycles, [&] { return curves_csv(measured.cycles, measured.name); }));
  return out;
}

// Walking drawn, where there is some; what cannot be drawn is told.
Result<std::unique_ptr<GaitReport>> draw_walking(const MeasuresJob& job, const Recording& recording,
                                                 const GaitNorms& norms, MeasuresOutcome& outcome) {
  if (job.figures.empty() && job.report.empty()) return nullptr;
  if (job.of == workflow::MeasuresOf::walking && !outcome.gait)
    outcome.warnings.push_back("no gait report is drawn, as there is no walking");
  if (!outcome.gait) return nullptr;
  std::vector<SheetInput> inputs;
  if (const auto curves = gait_curves(recording.trial, outcome.gait->cycles, job.gait.angles))
    add_curves(*curves, inputs);
  else if (!job.gait.angles.empty())
    return std::unexpected(curves.error());
  else if (job.gait.wanted() || !job.measures.empty())
    outcome.warnings.push_back("no angles are drawn: " + curves.error().message);
  add_recorded_kinetics(recording, *outcome.gait, inputs);
  if (inputs.empty() && !job.gait.wanted() && job.measures.empty()) return nullptr;
  auto report = make_gait_report(job.input.filename().string(), inputs, *outcome.gait, norms,
                                 job.gait.sheet.angle_angle);
  std::ranges::copy(report->sheet.remarks, std::back_inserter(outcome.warnings));
  return report;
}

}  // namespace

Status check_measures_output(const std::filesystem::path& output) {
  const auto ending = ending_of(output);
  if (output.empty() || ending == ".csv" || ending == ".json" || ending == ".nwb") return {};
  return fail(Code::usage, fmt::format("{}: measures are written as .csv, .json or .nwb", output.string()));
}

std::vector<std::filesystem::path> files_of(const MeasuresJob& job) {
  auto files = files_of(job.input, job);
  std::ranges::move(files_of(job.gait), std::back_inserter(files));
  files.insert(files.end(), {job.participants_file, job.forces});
  if (job.emg.maximum != "trial") files.emplace_back(job.emg.maximum);
  return files;
}

Result<MeasuresOutcome> run_measures(const MeasuresJob& given) {
  MeasuresJob job = given;
  if (auto s = check_measures_output(job.output); !s) return std::unexpected(s.error());
  if (auto s = job.RecordingOptions::check(); !s) return std::unexpected(s.error());
  const auto formats = parse_figure_formats(job.figure_formats);
  if (!formats) return std::unexpected(formats.error());
  const auto asked = asked_measures(job);
  if (!asked) return std::unexpected(asked.error());
  if (!job.participants_file.empty() && !job.participants) {
    auto read = read_participants(job.participants_file);
    if (!read) return std::unexpected(read.error());
    job.participants = std::make_shared<const Participants>(std::move(*read));
  }
  std::vector<std::filesystem::path> targets;
  for (const auto& path :
       {job.output, job.gait.write_events, job.gait.write_cycles, job.emg.write, job.emg.write_cycles})
    if (!path.empty()) targets.push_back(path);
  const auto norms = read_gait_norms(job.gait.sheet.norms);
  if (!norms) return std::unexpected(norms.error());
  auto staging = Staging::create(targets, job, files_of(job));
  if (!staging) return std::unexpected(staging.error());
  if (auto s = staging->add_page(job.report); !s) return std::unexpected(s.error());
  auto measured = measure_recording(job, *asked);
  if (!measured) return std::unexpected(measured.error());
  staging->add_inputs(inputs_of(measured->outcome));
  auto files = other_files(job, *measured);
  if (!files) return fail_at(job.input.string(), files.error());
  if (job.of == workflow::MeasuresOf::muscles)
    measured->outcome.gait.reset();  // walking only gave the cycles
  const auto report = draw_walking(job, measured->recording, *norms, measured->outcome);
  if (!report) return fail_at(job.input.string(), report.error());
  if (auto s = write_all(job, *formats, *measured, report->get(), std::move(*files), *staging); !s)
    return std::unexpected(s.error());
  return std::move(measured->outcome);
}

std::vector<data::InputFile> inputs_of(const MeasuresOutcome& outcome) {
  std::vector<data::InputFile> out{outcome.input};
  out.insert(out.end(), outcome.beside.begin(), outcome.beside.end());
  return out;
}

std::string commands_for(const MeasuresOutcome& outcome) {
  const bool plates = std::ranges::any_of(outcome.measures, [](const data::Measure& measure) {
    return workflow::kind_of_measure(measure.id) == workflow::MeasureKind::plates;
  });
  std::vector<std::string> commands;
  if (outcome.gait || plates) commands.emplace_back("'kinemark gait' (feet and force plates)");
  if (outcome.emg) commands.emplace_back("'kinemark emg' (electromyograms)");
  if (!outcome.noises.empty()) commands.emplace_back("'kinemark measure' (paths of markers)");
  return join(commands);
}

nlohmann::ordered_json measures_outcome_json(const MeasuresOutcome& outcome) {
  nlohmann::ordered_json out;
  out["input"] = {{"path", outcome.input.path},
                  {"bytes", outcome.input.bytes},
                  {outcome.input.hash_kind, outcome.input.hash}};
  out["measures"] = measures_json(outcome.measures);
  for (const auto& [region, cells] : outcome.spans.cells) {
    nlohmann::ordered_json trial{{"region", region}};
    for (std::size_t k = 0; k < cells.size(); ++k) trial["conditions"][outcome.spans.columns[k]] = cells[k];
    out["trials"].push_back(std::move(trial));
  }
  if (outcome.gait) out["gait"] = gait_json(*outcome.gait);
  if (!outcome.rhythms.empty()) out["rhythms"] = rhythms_json(outcome.rhythms);
  if (!outcome.noises.empty()) out["noise"] = noises_json(outcome.noises);
  out["written"] = nlohmann::ordered_json::array();
  for (const auto& path : outcome.written) out["written"].push_back(path.string());
  out["warnings"] = outcome.warnings;
  return out;
}

}  // namespace kinemark::pipeline
