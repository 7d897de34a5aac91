// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/file_facts.h"

namespace kinemark::cli {

void add_info(CLI::App& app, const Globals& globals, Run& run) {
  auto* command = app.add_subcommand("info", "What a marker, motion, model or recording file holds");
  const auto path = std::make_shared<std::string>();
  command->add_option("FILE", *path, ".c3d, .trc, .mot, .sto, .osim or .mcap")->required();
  command->callback([&globals, path, &run] {
    run = [&globals, path] {
      const auto facts = pipeline::describe_file(*path);
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
