// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/selection_options.h"
#include "kinemark/pipeline/files/convert_job.h"

namespace kinemark::cli {

void add_convert(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand("convert", "A file in another format of its kind");
  command->footer(
      "Markers: .c3d, .trc, .nwb, .csv; .v3d and the texts of QTM, Motive and Vicon in. Tables: .mot, .sto. "
      "Models: .osim, in their own version from 2.0 on, older ones as 4.0.");
  const auto job = std::make_shared<pipeline::ConvertJob>();
  command->add_option("IN", job->in, "File to read")->required();
  command->add_option("OUT", job->out, "File to write; its ending names the format")->required();
  command->add_option("--rate", job->rate_hz, "Frame rate of a marker file that stores none (.v3d), Hz");
  command->add_option("--rotate", job->rotate,
                      "Turn markers and force plates: axis and degrees, \"x -90\" makes z up into y up");
  add_selection_options(*command, job->selection);
  command->callback([&common, job, &run] {
    run = [&common, job] { return run_job(common, "files", *job, pipeline::run_convert, print_written); };
  });
}

}  // namespace kinemark::cli
