// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/measures_options.h"
#include "cli/recording_options.h"

namespace kinemark::cli {

void add_measure(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command =
      app.add_subcommand("measure", "Paths of markers: shape, timing, smoothness, each with an interval");
  command->footer(
      "Freed of the bias of noise, with 95 % intervals (docs/stages/measures.md); of several recordings, or "
      "of a\n"
      "folder of them, in one table (docs/stages/many-recordings.md). Spans, events and cycles are those of "
      "the\n"
      "markers' own movements, or those that --region and --between name.");
  const auto arguments = std::make_shared<MeasuresArguments>();
  auto& job = arguments->job;
  job.of = workflow::MeasuresOf::paths;
  command->add_option("IN", arguments->inputs, "A recording of markers, several, or a folder of them");
  add_recording_options(*command, job, pipeline::Doubtful::drop);
  add_measures_options(*command, *arguments);
  command
      ->add_option("--events", job.gait.events,
                   "movement: print the movements and cycles of each marker, and measure them, too")
      ->type_name("movement")
      ->check(CLI::IsMember({"movement"}))
      ->group("Measures");
  add_noise_option(*command, arguments->noise_mm);
  command
      ->add_option("-o,--output", job.output,
                   "Table of the measures, .csv, .json or .nwb; printed when absent")
      ->type_name("FILE")
      ->group("Output");
  add_cycle_options(*command, job.gait, CyclesOf::movements);
  add_drawing_options(*command, job, "each path in its plane, its speed and acceleration, its cycles",
                      "figures and tables");
  add_several_options(*command, *arguments);
  command->callback([&common, command, arguments, &run] {
    run = [&common, command, arguments] { return run_measures_command(common, *command, *arguments); };
  });
}

}  // namespace kinemark::cli
