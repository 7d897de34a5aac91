// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/files/info_json.h"
#include "kinemark/pipeline/files/input_list.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/files/validate_job.h"
#include "kinemark/pipeline/session/session.h"

namespace kinemark::cli {
namespace {

void print_validate_outcome(const CommonOptions& common, const pipeline::ValidateOutcome& outcome) {
  for (const auto& checked : outcome.files) {
    const std::string file = checked.file.string();
    if (checked.error) (void)report_error(*checked.error);
    for (const auto& warning : checked.warnings) say(common, fmt::format("{}: {}", file, warning));
    for (const auto& note : checked.notes) say(common, fmt::format("{}: note: {}", file, note));
    if (checked.exit_status() == 0) say(common, fmt::format("{}: good", file));
  }
  if (common.json) print_result(pipeline::json_text(pipeline::validate_json(outcome)) + "\n");
}

/// Trials of sessions in the place of their folders, once each is as it was recorded.
Status take_sessions(const CommonOptions& common, std::vector<std::filesystem::path>& files) {
  std::vector<std::filesystem::path> out;
  for (const auto& file : files) {
    if (!pipeline::is_session(file)) {
      out.push_back(file);
      continue;
    }
    const auto session = pipeline::Session::read(file);
    if (!session) return std::unexpected(session.error());
    if (auto s = session->check(); !s) return s;
    for (const auto& trial : session->trials()) out.push_back(file / trial.file);
    say(common, fmt::format("{}: the checksums of {} recordings are those of MANIFEST", file.string(),
                            session->trials().size()));
  }
  files = std::move(out);
  return {};
}

int run_command(const CommonOptions& common, pipeline::ValidateJob& job) {
  if (auto s = take_sessions(common, job.files); !s) return report_error(s.error());
  auto list = pipeline::list_inputs(job.files, pipeline::known_endings());
  if (!list) return report_error(list.error());
  job.files = std::move(list->files);
  for (const auto& note : list->notes) say(common, fmt::format("note: {}", note));
  return run_job(common, "files", job, pipeline::run_validate, print_validate_outcome);
}

}  // namespace

void add_validate(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand(
      "validate", "Check files: exit status 0 good, 1 readable but odd, 3 or 4 not readable");
  const auto job = std::make_shared<pipeline::ValidateJob>();
  job->recording.edits = io::kEditsNone;  // it is the file that is checked
  command->footer(
      "Of a folder: the files in it that can be read; of a session: its recordings, against their\n"
      "checksums. The exit status is the worst of all files.");
  command
      ->add_option("FILE", job->files,
                   ".c3d, .trc, .nwb, .csv, .tsv, .v3d, .mot, .sto, .osim, .mcap, or a folder of them")
      ->required();
  command->add_option("-m,--model", job->model,
                      "Model (.osim) that tables of coordinates are of: ranges that they leave are said");
  command->callback([&common, job, &run] { run = [&common, job] { return run_command(common, *job); }; });
}

}  // namespace kinemark::cli
