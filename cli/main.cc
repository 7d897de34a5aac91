// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <new>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/core/version.h"

namespace {

using kinemark::cli::Globals;
using kinemark::cli::Run;

constexpr const char* kFooter =
    "Exit status: 0 good, 1 ran but missed a quality gate, 2 usage, 3 bad input, 4 I/O, 5 device,\n"
    "130 and 143 stopped by a signal. 'kinemark COMMAND --help' lists a command's options, 'kinemark "
    "--help'\n"
    "those that every command takes.";

void add_globals(CLI::App& app, Globals& globals) {
  app.add_option("--threads", globals.threads, "Threads; 0 uses all cores. Any number gives the same bits.")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str()
      ->group("Everywhere");
  app.add_option("--seed", globals.seed, "Seed of everything random")
      ->capture_default_str()
      ->group("Everywhere");
  app.add_flag("--force", globals.force, "Replace files that exist")->group("Everywhere");
  app.add_flag("--quiet", globals.quiet, "Say nothing but errors")->group("Everywhere");
  app.add_flag("--json", globals.json, "Print the result as JSON on stdout")->group("Everywhere");
}

/// One sentence on the error in the command line and on where the options are explained.
int report_usage(const CLI::App& app, const std::string& what) {
  std::string command = "kinemark";
  for (const CLI::App* at = &app; !at->get_subcommands().empty();) {
    at = at->get_subcommands().front();
    command += " " + at->get_name();
  }
  return kinemark::cli::report_error(
      {kinemark::Code::usage, fmt::format("{}; see '{} --help'", what, command)});
}

int run_program(int argc, char** argv) {
  Globals globals;
  for (int i = 0; i < argc; ++i)
    globals.command_line += (i ? std::string(" ") : std::string()) + (i ? argv[i] : "kinemark");
  CLI::App app("From detector counts to joint angles, with an error bar on every number.", "kinemark");
  app.set_version_flag("--version", std::string("kinemark ") + kinemark::kVersion);
  app.footer(kFooter);
  app.require_subcommand(1);
  app.fallthrough();
  app.get_formatter()->column_width(36);
  add_globals(app, globals);
  Run run;
  kinemark::cli::add_simulate(app, globals, run);
  kinemark::cli::add_calibrate(app, globals, run);
  kinemark::cli::add_reconstruct(app, globals, run);
  kinemark::cli::add_clean(app, globals, run);
  kinemark::cli::add_joints(app, globals, run);
  kinemark::cli::add_scale(app, globals, run);
  kinemark::cli::add_ik(app, globals, run);
  kinemark::cli::add_track(app, globals, run);
  kinemark::cli::add_report(app, globals, run);
  kinemark::cli::add_study(app, globals, run);
  kinemark::cli::add_info(app, globals, run);
  kinemark::cli::add_convert(app, globals, run);
  kinemark::cli::add_validate(app, globals, run);
  kinemark::cli::add_recover(app, globals, run);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error, std::cout, std::cerr);
    return report_usage(app, error.what());
  }
  kinemark::cli::install_signal_handlers();
  const int status = run();
  if (std::fflush(stdout) != 0)
    return kinemark::cli::report_error({kinemark::Code::io, "standard output: cannot be written"});
  return status;
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
