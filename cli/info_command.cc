// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/files/file_facts.h"

namespace kinemark::cli {

void add_info(CLI::App& app, const Globals& globals, Run& run) {
  auto* command = app.add_subcommand("info", "What a marker, motion, model or recording file holds");
  struct Arguments {
    std::string path;
    double rate_hz = 0.0;
  };
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("FILE", arguments->path, ".c3d, .trc, .nwb, .csv, .v3d, .mot, .sto, .osim or .mcap")
      ->required();
  command->add_option("--rate", arguments->rate_hz,
                      "Frame rate of a marker file that stores none (.v3d), Hz");
  command->callback([&globals, arguments, &run] {
    run = [&globals, arguments] {
      const auto facts = pipeline::describe_file(arguments->path, arguments->rate_hz);
      if (!facts) return report_error(facts.error());
      if (globals.json)
        fmt::print("{}\n", facts->dump(2));
      else
        fmt::print("{}", pipeline::facts_text(*facts));
      return 0;
    };
  });
}

}  // namespace kinemark::cli
