// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/gait_drawing.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/gait/sheet_inputs.h"
#include "kinemark/pipeline/measures/event_table.h"
#include "kinemark/pipeline/measures/gait_cycles.h"
#include "kinemark/pipeline/measures/measure_figures.h"
#include "kinemark/pipeline/measures/recording_name.h"
#include "kinemark/workflow/prepare/vertical.h"
#include "kinemark/workflow/measures/measure.h"

namespace kinemark::pipeline {

void add_recorded_kinetics(const data::Recording& recording, const analysis::Gait& gait,
                           std::vector<SheetInput>& out) {
  add_kinetic_channels(recording.trial, gait.cycles, out);
  const auto vertical = workflow::vertical_of_plates(recording.trial);
  if (recording.plates && vertical) add_ground_reaction(*recording.plates, vertical->up, gait, out);
}

Result<GaitDrawing> GaitDrawing::begin(GaitDrawingJob job, const std::vector<std::filesystem::path>& others) {
  GaitDrawing out;
  if (auto s = job.gait.check(true); !s) return std::unexpected(s.error());
  auto formats = parse_figure_formats(job.figure_formats);
  if (!formats) return std::unexpected(formats.error());
  out.formats_ = std::move(*formats);
  auto norms = read_gait_norms(job.gait.sheet.norms);
  if (!norms) return std::unexpected(norms.error());
  out.norms_ = std::move(*norms);
  out.others_ = others;
  std::ranges::move(files_of(job.gait), std::back_inserter(out.others_));
  auto page = PageFile::begin(job.report, job, out.others_);
  if (!page) return std::unexpected(page.error());
  out.page_.emplace(std::move(*page));
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

Status GaitDrawing::write(const std::filesystem::path& path, const data::Trial& trial,
                          const std::vector<data::CycleCurves>& curves, const std::vector<SheetInput>& inputs,
                          GaitPageFacts facts, JobOutcome& outcome) {
  for (const auto& input : facts.inputs) others_.emplace_back(input.path);
  page_->add_inputs(facts.inputs);
  const auto name = path.filename().string();
  const auto recording = name_of_recording(path);
  const auto events = events_of(*gait_, trial.markers.time);
  std::vector<std::filesystem::path> targets;
  std::vector<ResultFile> files;
  data::Trial recorded;
  if (const auto& target = job_.gait.write_events; !target.empty()) {
    targets.push_back(target);
    if (ending_of(target) == ".c3d") {
      recorded = with_events(trial, events);
      files.push_back(marker_file(target, recorded));
    } else {
      files.push_back(text_file(target, [&] { return events_csv(events, recording); }));
    }
  }
  if (const auto& target = job_.gait.write_cycles; !target.empty()) {
    targets.push_back(target);
    files.push_back(text_file(target, [&] { return curves_csv({{"", curves}}, recording); }));
  }
  if (!files.empty()) {
    auto staging = Staging::create(targets, job_, others_);
    if (!staging) return std::unexpected(staging.error());
    auto written = write_results(*staging, files, {}, "walking");
    if (!written) return std::unexpected(written.error());
    std::ranges::move(*written, std::back_inserter(outcome.written));
  }
  if (job_.figures.empty() && !page_->wanted()) return {};
  const auto report = make_gait_report(name, inputs, *gait_, norms_, job_.gait.sheet.angle_angle);
  std::ranges::copy(report->sheet.remarks, std::back_inserter(outcome.warnings));
  if (!job_.figures.empty()) {
    auto staging = Staging::create_in(job_.figures, gait_report_files(*report, formats_), job_, others_);
    if (!staging) return std::unexpected(staging.error());
    auto written =
        write_results(*staging, gait_report_results(*report, job_.figures, formats_), {}, "the figures");
    if (!written) return std::unexpected(written.error());
    std::ranges::move(*written, std::back_inserter(outcome.written));
  }
  if (!page_->wanted()) return {};
  facts.command_line = job_.command_line;
  facts.warnings = outcome.warnings;
  return page_->write(gait_report_page(*report, facts), outcome);
}

}  // namespace kinemark::pipeline
