// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/many_inputs.h"
#include "cli/recording_options.h"
#include "kinemark/pipeline/files/file_table.h"
#include "kinemark/pipeline/files/info_json.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::cli {
namespace {

struct InfoArguments {
  std::vector<std::filesystem::path> given;
  pipeline::RecordingOptions recording;
};

int show_one(const CommonOptions& common, const InfoArguments& arguments) {
  pipeline::InfoJob job;
  job.file = arguments.given.front();
  static_cast<pipeline::RecordingOptions&>(job) = arguments.recording;
  settle(common, "files", job);
  const auto outcome = pipeline::run_info(job);
  if (!outcome) return report_error(outcome.error());
  if (common.json)
    print_result(pipeline::json_text(pipeline::info_json(*outcome)) + "\n");
  else
    print_result(pipeline::info_text(*outcome));
  return outcome->exit_status();
}

int show_many(const CommonOptions& common, const InfoArguments& arguments) {
  pipeline::ValidateJob job;
  job.recording = arguments.recording;
  if (auto s = pipeline::check_for_several(job.recording); !s) return report_error(s.error());
  auto list = pipeline::list_inputs(arguments.given, pipeline::known_endings());
  if (!list) return report_error(list.error());
  job.files = std::move(list->files);
  settle(common, "files", job);
  const auto outcome = pipeline::run_validate(job);
  if (!outcome) return report_error(outcome.error());
  for (const auto& note : list->notes) say(common, fmt::format("note: {}", note));
  if (common.json)
    print_result(pipeline::json_text(pipeline::files_json(*outcome)) + "\n");
  else
    print_result(pipeline::file_table(*outcome));
  int worst = 0;
  for (const auto& checked : outcome->files) {
    if (!checked.error) continue;
    worst = std::max(worst, checked.exit_status());
    if (common.json) (void)report_error(*checked.error);
  }
  return worst;
}

}  // namespace

void add_info(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand("info", "What marker, motion, model and recording files hold");
  command->footer(
      "Of several files, or a folder: a line each and the totals; the exit status is the worst of all "
      "files.");
  const auto arguments = std::make_shared<InfoArguments>();
  command
      ->add_option("FILE", arguments->given,
                   ".c3d, .trc, .nwb, .csv, .tsv, .v3d, .mot, .sto, .osim, .mcap, .vsk, or a folder of them")
      ->required();
  add_recording_options(*command, arguments->recording, pipeline::Doubtful::keep);
  command->callback([&common, arguments, &run] {
    run = [&common, arguments] {
      return are_many(arguments->given) ? show_many(common, *arguments) : show_one(common, *arguments);
    };
  });
}

}  // namespace kinemark::cli
