// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/motion/report_job.h"

namespace kinemark::cli {

void add_report(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand("report", "One self-contained page of a solved trial");
  const auto job = std::make_shared<pipeline::ReportJob>();
  command->add_option("IN", job->solved, "Q.mot as written by 'kinemark ik', with its companions beside it")
      ->required();
  command->add_option("-o,--output", job->page, "Page to write, R.html")->required();
  command->callback([&common, job, &run] {
    run = [&common, job] { return run_job(common, "pages", *job, pipeline::run_report, print_written); };
  });
}

}  // namespace kinemark::cli
