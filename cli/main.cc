// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/command_tree.h"
#include "cli/console.h"
#include "cli/files_read.h"
#include "cli/hints.h"
#include "cli/option_needs.h"
#include "cli/program.h"
#include "cli/settings_options.h"

namespace {

using kinemark::cli::CommonOptions;
using kinemark::cli::Run;

/// One sentence on the error in the command line and on where the options are explained.
int report_usage(const CLI::App& app, const std::string& what) {
  std::string command;
  for (const CLI::App* at = &kinemark::cli::reached(app); at != nullptr; at = at->get_parent())
    command = at->get_name() + (command.empty() ? "" : " ") + command;
  return kinemark::cli::report_error(
      {kinemark::Code::usage, fmt::format("{}; see '{} --help'", what, command)});
}

int report_lost_output() {
  return kinemark::cli::report_error({kinemark::Code::io, "standard output: cannot be written"});
}

int run_program(int argc, char** argv) {
  CommonOptions common;
  Run run;
  CLI::App app("From detector counts to joint angles, with an error bar on every number.", "kinemark");
  kinemark::cli::add_everything(app, common, run);
  const auto words = kinemark::cli::with_settings(app, std::vector<std::string>(argv + 1, argv + argc));
  if (!words) return kinemark::cli::report_error(words.error());
  common.command_line = "kinemark";
  for (const auto& word : words->words)
    if (!word.starts_with("--reads=")) common.command_line += " " + word;
  try {
    app.parse(std::vector<std::string>(words->words.rbegin(), words->words.rend()));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      kinemark::cli::hide_for_help(app);
      app.exit(error, std::cout, std::cerr);
      return std::cout.flush() ? 0 : report_lost_output();
    }
    return report_usage(app, kinemark::cli::explain_usage(app, error, words->words));
  }
  if (const auto s = kinemark::cli::check_needs(kinemark::cli::reached(app)); !s)
    return report_usage(app, s.error().message);
  common.kept = kinemark::cli::files_read(app);
  if (!words->config.empty()) common.kept.push_back(words->config);
  kinemark::cli::watch_signals();
  if (!common.save_config.empty())
    if (const auto s = kinemark::cli::save_settings(app, common); !s)
      return kinemark::cli::report_error(s.error());
  const int status = run();
  return kinemark::cli::output_failed() ? report_lost_output() : status;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_program(argc, argv);
  } catch (const std::bad_alloc&) {
    return kinemark::cli::report_error({kinemark::Code::io, "out of memory"});
  } catch (const std::exception& error) {
    return kinemark::cli::report_error({kinemark::Code::bad_input, error.what()});
  }
}
