// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/gait_drawing.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/pipeline/gait/sheet_inputs.h"
#include "kinemark/pipeline/measures/event_table.h"
#include "kinemark/pipeline/measures/measure_figures.h"
#include "kinemark/pipeline/measures/recording_name.h"
#include "kinemark/stages/analysis/path/path_measures.h"
#include "kinemark/workflow/measures/measure.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline {

void add_recorded_kinetics(const data::Recording& recording, const analysis::Gait& gait,
                           std::vector<SheetInput>& out) {
  add_kinetic_channels(recording.trial, gait.cycles, out);
  const auto vertical = workflow::vertical_of_plates(recording.trial);
  if (recording.plates && vertical) add_ground_reaction(*recording.plates, vertical->up, gait, out);
}

Result<GaitDrawing> GaitDrawing::begin(GaitDrawingJob job, Staging& staging) {
  GaitDrawing out;
  if (auto s = job.gait.check(true); !s) return std::unexpected(s.error());
  const analysis::PathMeasureOptions intervals{
      .refits = job.refits, .noise_sd_m = job.noise_sd_m, .level = job.level};
  if (auto s = intervals.check(); !s) return std::unexpected(s.error());
  auto formats = parse_figure_formats(job.figure_formats);
  if (!formats) return std::unexpected(formats.error());
  out.formats_ = std::move(*formats);
  auto norms = read_gait_norms(job.gait.sheet.norms);
  if (!norms) return std::unexpected(norms.error());
  out.norms_ = std::move(*norms);
  staging.add_inputs(files_of(job.gait));
  for (const auto& path : {job.gait.write_events, job.gait.write_cycles})
    if (!path.empty())
      if (auto status = staging.add({path}); !status) return std::unexpected(status.error());
  if (auto status = staging.add_page(job.report); !status) return std::unexpected(status.error());
  out.job_ = std::move(job);
  return out;
}

Status GaitDrawing::find_walking(const data::Recording& recording) {
  auto options = gait_options(job_.gait, true);
  if (!options) return std::unexpected(options.error());
  options->refits = job_.refits;
  options->level = job_.level;
  options->noise_sd_m = job_.noise_sd_m;
  options->seed = job_.seed;
  options->threads = job_.threads;
  auto gait = workflow::measure_gait(recording, *options);
  if (!gait) return std::unexpected(gait.error());
  gait_ = std::move(*gait);
  return {};
}

std::vector<ResultFile> GaitDrawing::tables(const std::filesystem::path& path, const data::Trial& trial,
                                            const std::vector<data::CycleCurves>& curves) {
  const auto recording = name_of_recording(path);
  const auto events = events_of(*gait_, trial.markers.time);
  std::vector<ResultFile> files;
  if (const auto& target = job_.gait.write_events; job_.gait.into_recording()) {
    recorded_ = with_events(trial, events);
    files.push_back(marker_file(target, recorded_));
  } else if (!target.empty()) {
    files.push_back(text_file(target, [text = events_csv(events, recording)] { return text; }));
  }
  if (const auto& target = job_.gait.write_cycles; !target.empty())
    files.push_back(text_file(target, [text = curves_csv({{"", curves}}, recording)] { return text; }));
  return files;
}

Result<std::vector<ResultFile>> GaitDrawing::draw(const std::filesystem::path& path, const data::Trial& trial,
                                                  const std::vector<data::CycleCurves>& curves,
                                                  const std::vector<SheetInput>& inputs, GaitPageFacts facts,
                                                  Staging& staging, JobOutcome& outcome) {
  staging.add_inputs(facts.inputs);
  auto files = tables(path, trial, curves);
  if (job_.figures.empty() && job_.report.empty()) return files;
  report_ = make_gait_report(path.filename().string(), inputs, *gait_, norms_, job_.gait.sheet.angle_angle);
  std::ranges::copy(report_->sheet.remarks, std::back_inserter(outcome.warnings));
  if (!job_.figures.empty()) {
    if (auto s = staging.add_in(job_.figures, gait_report_files(*report_, formats_)); !s)
      return std::unexpected(s.error());
    std::ranges::move(gait_report_results(*report_, job_.figures, formats_), std::back_inserter(files));
  }
  if (job_.report.empty()) return files;
  facts.command_line = job_.command_line;
  facts.warnings = outcome.warnings;
  facts.gates = outcome.gates;
  files.push_back(
      text_file(job_.report, [this, facts = std::move(facts)] { return gait_report_page(*report_, facts); }));
  return files;
}

}  // namespace kinemark::pipeline
