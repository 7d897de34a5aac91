// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/files/info_json.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/files/recover_job.h"

namespace kinemark::cli {

void add_recover(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command =
      app.add_subcommand("recover", "A whole recording from one that was cut, damaged or never closed");
  command->footer(
      "Keeps every message whose checksum is right, those beyond the damage too, and writes down in the new\n"
      "file what was left out. The original is only read. Exit status 1 when bytes had to be left out.");
  const auto job = std::make_shared<pipeline::RecoverJob>();
  command->add_option("IN", job->in, "Recording to read (.mcap)")->required();
  command->add_option("OUT", job->out, "Recording to write")->required();
  command->callback([&common, job, &run] {
    run = [&common, job] {
      settle(common, "messages", *job);
      const auto outcome = pipeline::run_recover(*job);
      if (!outcome) return report_error(outcome.error());
      for (const auto& warning : outcome->warnings)
        say(common, fmt::format("{}: {}", job->in.string(), warning));
      say(common, fmt::format("wrote {}: {} messages", job->out.string(), outcome->messages));
      if (common.json) print_result(pipeline::json_text(pipeline::recover_json(*outcome)) + "\n");
      return outcome->exit_status();
    };
  });
}

}  // namespace kinemark::cli
