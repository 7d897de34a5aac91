// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/measures_options.h"
#include "cli/recording_options.h"

namespace kinemark::cli {

void add_emg(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command =
      app.add_subcommand("emg", "Electromyograms: envelopes, onsets, amplitudes, over spans and gait cycles");
  command->footer(
      "Rectified and smoothed, in volts or to a maximum (docs/stages/force-measures.md). Cycles are those of "
      "walking.");
  const auto arguments = std::make_shared<MeasuresArguments>();
  auto& job = arguments->job;
  job.of = workflow::MeasuresOf::muscles;
  command->add_option("IN", arguments->inputs, "A recording of markers, several, or a folder of them");
  add_recording_options(*command, job, pipeline::Doubtful::drop);
  add_emg_options(*command, job.emg, kOwnEmgNames);
  add_feet_options(*command, job.gait);
  add_measures_options(*command, *arguments);
  command
      ->add_option("-o,--output", job.output,
                   "Table of the measures, .csv, .json or .nwb; printed when absent")
      ->type_name("FILE")
      ->group("Output");
  command->add_option("--report", job.report, "Page to write as well, .html: the table of measures")
      ->type_name("FILE")
      ->group("Output");
  add_several_options(*command, *arguments);
  command->callback([&common, command, arguments, &run] {
    run = [&common, command, arguments] { return run_measures_command(common, *command, *arguments); };
  });
}

}  // namespace kinemark::cli
