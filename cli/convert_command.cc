// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/files/convert_job.h"

namespace kinemark::cli {

void add_convert(CLI::App& app, const Globals& globals, Run& run) {
  auto* command = app.add_subcommand("convert", "A file in another format of its kind");
  command->footer(
      "Markers: .c3d, .trc, .nwb, .csv, and .v3d in. Tables: .mot, .sto. Models: .osim of any version in, "
      "4.0 out.");
  struct Arguments {
    std::string in, out;
    double rate_hz = 0.0;
  };
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("IN", arguments->in, "File to read")->required();
  command->add_option("OUT", arguments->out, "File to write; its ending names the format")->required();
  command->add_option("--rate", arguments->rate_hz,
                      "Frame rate of a marker file that stores none (.v3d), Hz");
  command->callback([&globals, arguments, &run] {
    run = [&globals, arguments] {
      const auto warnings =
          pipeline::convert_file(arguments->in, arguments->out, globals.force, arguments->rate_hz);
      if (!warnings) return report_error(warnings.error());
      print_written(globals, {arguments->out}, *warnings);
      return 0;
    };
  });
}

}  // namespace kinemark::cli
