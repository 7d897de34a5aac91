// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/child_command.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/program.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/run/run_job.h"

namespace kinemark::cli {
namespace {

void print_outcome(const CommonOptions& common, const pipeline::RunJob& job,
                   const pipeline::RunOutcome& outcome) {
  if (common.json)
    print_result(pipeline::json_text(pipeline::run_json(outcome)) + "\n");
  else if (job.plan_only)
    print_result(pipeline::commands_text(outcome));
  else if (!common.quiet)
    print_result(pipeline::run_table(outcome));
}

int run_command(const CommonOptions& common, pipeline::RunJob& job) {
  settle(common, "steps", job);
  job.check = check_words;
  job.start = run_child;
  const auto outcome = pipeline::run_study(job);
  if (!outcome) return report_error(outcome.error());
  for (const auto& each : outcome->steps)
    if (each.status == pipeline::TrialStatus::failed)
      (void)report_error({.code = Code::bad_input, .message = each.said});
  print_outcome(common, job, *outcome);
  return outcome->exit_status();
}

}  // namespace

void add_run(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command =
      app.add_subcommand("run", "A whole study: the steps that a file names, for all its recordings");
  command->footer(
      "STUDY.toml names subjects, recordings, steps (joints, scale, clean, ik, track, analyze, report) and "
      "their "
      "options:\n"
      "docs/formats/run.md. What is done already, with the same options and inputs, is not done again.");
  const auto job = std::make_shared<pipeline::RunJob>();
  command->add_option("STUDY", job->file, "Run file, STUDY.toml")->type_name("FILE")->required();
  command->add_option("--subject", job->only, "Do this subject alone. Repeatable.")->type_name("NAME");
  command->add_option("--jobs", job->jobs, "Steps at a time; 0: one for each core. The bits are the same.")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_flag("--keep-going", job->keep_going, "Go on with the others when a step has failed");
  command->add_flag("--dry-run", job->plan_only, "Print the commands and do nothing");
  command->callback([&common, job, &run] { run = [&common, job] { return run_command(common, *job); }; });
}

}  // namespace kinemark::cli
