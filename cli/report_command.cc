// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/recording_options.h"
#include "kinemark/pipeline/motion/report_job.h"

namespace kinemark::cli {

void add_report(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand("report", "One self-contained page of a recording or of a solved trial");
  command->footer(
      "Of a marker file the page shows what there is of each marker, in space and over time; of joint "
      "angles\n"
      "what 'kinemark ik --report' shows. It opens in any browser, without a network.");
  const auto job = std::make_shared<pipeline::ReportJob>();
  command
      ->add_option("IN", job->input,
                   "Marker file (.c3d, .trc, .nwb, .csv, .v3d, ...), or Q.mot as written by 'kinemark ik', "
                   "with its companions beside it")
      ->required();
  command->add_option("-o,--output", job->page, "Page to write, R.html")->required();
  add_recording_options(*command, *job, pipeline::Doubtful::keep);
  command
      ->add_option("--skeleton", job->skeleton, "Skeleton of an .amc file, .asf; default: the one beside it")
      ->group("Input");
  command
      ->add_option(
          "--geometry", job->geometry,
          "Folder with the meshes that the .osim names, of joint angles; looked into after the model's "
          "own folder and Geometry/ there. Repeatable.")
      ->group("Input");
  command->callback([&common, job, &run] {
    run = [&common, job] { return run_job(common, "pages", *job, pipeline::run_report, print_written); };
  });
}

}  // namespace kinemark::cli
