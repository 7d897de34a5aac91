// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/motion/report_job.h"

namespace kinemark::cli {

void add_report(CLI::App& app, const Globals& globals, Run& run) {
  auto* command = app.add_subcommand("report", "One self-contained page of a solved trial");
  struct Arguments {
    std::string solved, page;
  };
  const auto arguments = std::make_shared<Arguments>();
  command
      ->add_option("IN", arguments->solved,
                   "Q.mot as written by 'kinemark ik', with its companions beside it")
      ->required();
  command->add_option("-o,--output", arguments->page, "Page to write, R.html")->required();
  command->callback([&globals, arguments, &run] {
    run = [&globals, arguments] {
      const auto status = pipeline::write_report(arguments->solved, arguments->page, globals.force);
      if (!status) return report_error(status.error());
      print_written(globals, {arguments->page});
      return 0;
    };
  });
}

}  // namespace kinemark::cli
