// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/measures_options.h"
#include "cli/recording_options.h"

namespace kinemark::cli {

void add_gait(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command =
      app.add_subcommand("gait", "Feet and force plates: events, strides, steps, angles over the gait cycle");
  command->footer(
      "Foot strikes and foot offs from plates, markers or the file, each with its deviation; measures of "
      "strides,\n"
      "of steps and standing on plates (docs/stages/gait.md, docs/stages/force-measures.md). With --report: "
      "the\n"
      "gait report.");
  const auto arguments = std::make_shared<MeasuresArguments>();
  auto& job = arguments->job;
  job.of = workflow::MeasuresOf::walking;
  command->add_option("IN", arguments->inputs, "A recording of markers, several, or a folder of them");
  add_recording_options(*command, job, pipeline::Doubtful::drop);
  add_forces_option(*command, job.forces);
  add_feet_options(*command, job.gait);
  add_angles_option(*command, job.gait);
  add_sheet_options(*command, job.gait);
  add_measures_options(*command, *arguments);
  add_noise_option(*command, arguments->noise_mm);
  command
      ->add_option("-o,--output", job.output,
                   "Table of the measures, .csv, .json or .nwb; printed when absent")
      ->type_name("FILE")
      ->group("Output");
  add_cycle_options(*command, job.gait, CyclesOf::feet);
  add_drawing_options(*command, job, "angles, moments and powers over the gait cycle",
                      "the gait report; with force plates its figures and a table of all measures");
  add_several_options(*command, *arguments);
  command->callback([&common, command, arguments, &run] {
    run = [&common, command, arguments] { return run_measures_command(common, *command, *arguments); };
  });
}

}  // namespace kinemark::cli
