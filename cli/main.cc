// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <limits>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/hints.h"
#include "cli/metavars.h"
#include "cli/settings_options.h"
#include "kinemark/core/version.h"

namespace {

using kinemark::cli::CommonOptions;
using kinemark::cli::Run;

constexpr const char* kFooter =
    "Exit status: 0 good, 1 ran but missed a quality gate, 2 usage, 3 bad input, 4 I/O, 5 device,\n"
    "129, 130 and 143 stopped by a signal. 'kinemark COMMAND --help' lists a command's options, 'kinemark "
    "--help'\n"
    "those that every command takes.";

/// CLI11 takes -1 and numbers beyond 64 bits for others.
std::string whole_number(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size()) return "";
  return fmt::format("'{}' is not a whole number from 0 to {}", text,
                     std::numeric_limits<std::uint64_t>::max());
}

void add_common_options(CLI::App& app, CommonOptions& common) {
  app.add_option("--threads", common.threads, "Threads; 0 uses all cores. Any number gives the same bits.")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str()
      ->group("Everywhere");
  app.add_option("--seed", common.seed, "Seed of everything random")
      ->check(whole_number)
      ->capture_default_str()
      ->group("Everywhere");
  app.add_option("--config", common.config, "Take options from a file: max-rms = 20")
      ->type_name("FILE.toml")
      ->group("Everywhere");
  app.add_option("--save-config", common.save_config, "Write the options given to a file for --config")
      ->type_name("FILE.toml")
      ->group("Everywhere");
  app.add_flag("--force", common.force, "Replace files that exist")->group("Everywhere");
  app.add_flag("--quiet", common.quiet, "Say nothing but errors")->group("Everywhere");
  app.add_flag("--json", common.json, "Print the result as JSON on stdout")->group("Everywhere");
}

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
  CLI::App app("From detector counts to joint angles, with an error bar on every number.", "kinemark");
  app.set_version_flag("--version", std::string("kinemark ") + kinemark::kVersion);
  app.footer(kFooter);
  app.require_subcommand(1);
  app.fallthrough();
  app.get_formatter()->column_width(36);
  add_common_options(app, common);
  Run run;
  kinemark::cli::add_simulate(app, common, run);
  kinemark::cli::add_calibrate(app, common, run);
  kinemark::cli::add_reconstruct(app, common, run);
  kinemark::cli::add_clean(app, common, run);
  kinemark::cli::add_joints(app, common, run);
  kinemark::cli::add_scale(app, common, run);
  kinemark::cli::add_ik(app, common, run);
  kinemark::cli::add_track(app, common, run);
  kinemark::cli::add_report(app, common, run);
  kinemark::cli::add_study(app, common, run);
  kinemark::cli::add_info(app, common, run);
  kinemark::cli::add_convert(app, common, run);
  kinemark::cli::add_validate(app, common, run);
  kinemark::cli::add_recover(app, common, run);
  kinemark::cli::add_help(app, common, run);
  kinemark::cli::add_completion(app, common, run);
  kinemark::cli::name_values(app);
  const auto words = kinemark::cli::with_settings(app, std::vector<std::string>(argv + 1, argv + argc));
  if (!words) return kinemark::cli::report_error(words.error());
  common.command_line = "kinemark";
  for (const auto& word : *words) common.command_line += " " + word;
  try {
    app.parse(std::vector<std::string>(words->rbegin(), words->rend()));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      app.exit(error, std::cout, std::cerr);
      return std::cout.flush() ? 0 : report_lost_output();
    }
    return report_usage(app, kinemark::cli::explain_usage(app, error, *words));
  }
  kinemark::cli::watch_signals();
  if (!common.save_config.empty())
    if (const auto s = kinemark::cli::save_settings(app, common.save_config, common.force); !s)
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
