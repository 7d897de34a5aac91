// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/around_options.h"
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
      "markers' own movements, trials of an .nwb, or those that --region and --between name. --around: "
      "averages "
      "of\n"
      "movement and spikes around each other (docs/stages/around.md).");
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
  command
      ->add_option("--trials", job.trials,
                   "Intervals of an .nwb whose spans are measured, or none; its trials when absent, where no "
                   "other span is asked for")
      ->type_name("NAME")
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
  const auto around = std::make_shared<AroundArguments>();
  add_around_options(*command, *around);
  command->callback([&common, command, arguments, around, &run] {
    run = [&common, command, arguments, around] {
      if (!around->job.what.empty()) return run_around_command(common, *command, *arguments, *around);
      return run_measures_command(common, *command, *arguments);
    };
  });
}

}  // namespace kinemark::cli
