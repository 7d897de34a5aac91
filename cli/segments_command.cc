// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/dynamics_options.h"
#include "cli/heeded_options.h"
#include "cli/measures_options.h"
#include "cli/recording_options.h"
#include "cli/segments_options.h"

namespace kinemark::cli {
namespace {

struct SegmentsArguments {
  pipeline::SegmentsJob segments;
  MeasuresArguments measures;  ///< what segments share with measures
};

int run_command(const CommonOptions& common, const CLI::App& command, SegmentsArguments& arguments) {
  const auto& input = arguments.segments.input;
  if (is_motion_file(input))
    return report_error(
        {.code = Code::usage,
         .message = input.string() + " is a motion, no recording of markers; its angles are its columns"});
  if (auto s = check_heeded(command, AnalysisKind::segments, input.filename().string()); !s)
    return report_error(s.error());
  return run_segments_command(common, arguments.segments, arguments.measures);
}

}  // namespace

void add_segments(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand(
      "segments", "Segment frames, joint centres, angles and moments by a definition, without a body model");
  command->footer(
      "Plug-in Gait, ISB shoulder, or a definition of your own (docs/stages/segments.md); beside angles that "
      "the\n"
      "file holds, how well they agree. With force plates: forces, moments and powers of joints.");
  const auto arguments = std::make_shared<SegmentsArguments>();
  auto& job = arguments->segments;
  auto& shared = arguments->measures.job;
  command->add_option("IN", job.input, "A recording of markers")->required();
  add_recording_options(*command, shared, pipeline::Doubtful::drop);
  add_segments_options(*command, job, "--definition");
  add_forces_option(*command, job.forces);
  add_feet_options(*command, shared.gait);
  add_sheet_options(*command, shared.gait);
  add_noise_option(*command, arguments->measures.noise_mm);
  add_interval_options(*command, shared);
  command
      ->add_option("-o,--output", job.output,
                   "Folder for the results; their summary is printed alone when absent")
      ->type_name("FOLDER")
      ->group("Output");
  add_cycle_options(*command, shared.gait, CyclesOf::feet);
  add_drawing_options(*command, shared, "angles, moments and powers over the gait cycle", "the gait report");
  command->get_option("--definition")->required();
  command->callback([&common, command, arguments, &run] {
    run = [&common, command, arguments] { return run_command(common, *command, *arguments); };
  });
}

}  // namespace kinemark::cli
