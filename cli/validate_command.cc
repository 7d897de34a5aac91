// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/files/outcome_json.h"
#include "kinemark/pipeline/files/validate_job.h"

namespace kinemark::cli {
namespace {

void print_outcome(const Globals& globals, const pipeline::ValidateOutcome& outcome) {
  for (const auto& checked : outcome.files) {
    const std::string file = checked.file.string();
    if (checked.error) (void)report_error(*checked.error);
    for (const auto& warning : checked.warnings) say(globals, fmt::format("{}: {}", file, warning));
    if (checked.exit_status() == 0) say(globals, fmt::format("{}: good", file));
  }
  if (globals.json) fmt::print("{}\n", pipeline::validate_json(outcome).dump(2));
}

int run_command(const Globals& globals, pipeline::ValidateJob& job) {
  settle(globals, "files", job);
  const auto outcome = pipeline::run_validate(job);
  if (!outcome) return report_error(outcome.error());
  print_outcome(globals, *outcome);
  return outcome->exit_status();
}

}  // namespace

void add_validate(CLI::App& app, const Globals& globals, Run& run) {
  auto* command = app.add_subcommand(
      "validate", "Check files: exit status 0 good, 1 readable but odd, 3 or 4 not readable");
  const auto job = std::make_shared<pipeline::ValidateJob>();
  command->add_option("FILE", job->files, ".c3d, .trc, .mot, .sto, .osim or .mcap")->required();
  command->callback([&globals, job, &run] { run = [&globals, job] { return run_command(globals, *job); }; });
}

}  // namespace kinemark::cli
