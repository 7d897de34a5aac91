// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/files/info_json.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::cli {

void add_info(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand("info", "What a marker, motion, model or recording file holds");
  const auto job = std::make_shared<pipeline::InfoJob>();
  command->add_option("FILE", job->file, ".c3d, .trc, .nwb, .csv, .tsv, .v3d, .mot, .sto, .osim or .mcap")
      ->required();
  command->add_option("--rate", job->rate_hz, "Frame rate of a marker file that stores none (.v3d), Hz");
  command->callback([&common, job, &run] {
    run = [&common, job] {
      settle(common, "files", *job);
      const auto outcome = pipeline::run_info(*job);
      if (!outcome) return report_error(outcome.error());
      if (common.json)
        print_result(pipeline::json_text(pipeline::info_json(*outcome)) + "\n");
      else
        print_result(pipeline::info_text(*outcome));
      return outcome->exit_status();
    };
  });
}

}  // namespace kinemark::cli
