// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/command_tree.h"
#include "cli/console.h"
#include "cli/hints.h"
#include "cli/manual.h"
#include "kinemark/io/markers/lost_parts.h"
#include "kinemark/pipeline/files/result_files.h"

namespace kinemark::cli {
namespace {

struct HelpArguments {
  std::vector<std::string> words;
  bool manual = false;
  bool formats = false;
  std::string folder;
};

const CLI::App* find_command(const CLI::App& app, const std::string& name) {
  const auto found =
      app.get_subcommands([&](const CLI::App* command) { return command->get_name() == name; });
  return found.empty() ? nullptr : found.front();
}

int print_help(const CLI::App& app, const HelpArguments& arguments) {
  const CLI::App* at = &app;
  std::string path = "kinemark";
  for (const auto& word : arguments.words) {
    const CLI::App* next = find_command(*at, word);
    if (next == nullptr)
      return report_error(
          {Code::usage, fmt::format("{}; see '{} --help'", unknown_command(*at, word), path)});
    at = next;
    path += " " + word;
  }
  if (!arguments.manual) {
    print_result(at->get_formatter()->make_help(at, path, CLI::AppFormatMode::Normal));
    return 0;
  }
  const auto top = command_tree(app);
  for (const auto* command : all_commands(top))
    if (command->words == arguments.words) print_result(manual_page(*command, top));
  return 0;
}

int write_manual(const CLI::App& app, const CommonOptions& common, const std::filesystem::path& folder) {
  const auto top = command_tree(app);
  std::vector<std::filesystem::path> targets;
  std::vector<pipeline::ResultFile> pages;
  for (const auto* command : all_commands(top)) {
    targets.push_back(folder / (manual_name(*command) + ".1"));
    pages.push_back(
        pipeline::text_file(targets.back(), [command, &top] { return manual_page(*command, top); }));
  }
  pipeline::JobSettings job;
  job.force = common.force;
  job.kept = common.kept;
  auto staging = pipeline::Staging::create(targets, job, {});
  if (!staging) return report_error(staging.error());
  const auto written = pipeline::write_results(*staging, pages, {}, "the manual");
  return written ? 0 : report_error(written.error());
}

}  // namespace

void add_help(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand("help", "What a command does and takes: the same as COMMAND --help");
  const auto arguments = std::make_shared<HelpArguments>();
  command->add_option("COMMAND", arguments->words, "Command, and what it is of: simulate rig");
  command->add_flag("--man", arguments->manual, "As a manual page, for 'man -l -'");
  command->add_option("--man-pages", arguments->folder,
                      "Write the manual pages of all commands into a folder that exists");
  command->add_flag("--formats", arguments->formats,
                    "Formats of marker files: read, written, and what each of them keeps");
  command->callback([&app, &common, arguments, &run] {
    run = [&app, &common, arguments] {
      if (arguments->formats) {
        print_result(io::marker_format_table());
        return 0;
      }
      return arguments->folder.empty() ? print_help(app, *arguments)
                                       : write_manual(app, common, arguments->folder);
    };
  });
}

}  // namespace kinemark::cli
