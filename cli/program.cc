// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/program.h"

#include <charconv>
#include <cstdint>
#include <limits>
#include <system_error>

#include "cli/hints.h"
#include "cli/metavars.h"
#include "cli/option_needs.h"
#include "kinemark/core/version.h"

namespace kinemark::cli {
namespace {

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
  app.add_option("--reads", common.reads, "Files that are read elsewhere and must stay as they are")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group("");  // what `run` says to the commands that it starts; hidden
  app.add_flag("--force", common.force, "Replace files that exist")->group("Everywhere");
  app.add_flag("--quiet", common.quiet, "Say nothing but errors")->group("Everywhere");
  app.add_flag("--json", common.json, "Print the result as JSON on stdout")->group("Everywhere");
}

}  // namespace

void add_everything(CLI::App& app, CommonOptions& common, Run& run) {
  app.set_version_flag("--version", std::string("kinemark ") + kinemark::kVersion);
  app.footer(kFooter);
  app.require_subcommand(1);
  app.fallthrough();
  app.get_formatter()->column_width(36);
  add_common_options(app, common);
  add_simulate(app, common, run);
  add_acquire(app, common, run);
  add_calibrate(app, common, run);
  add_reconstruct(app, common, run);
  add_edit(app, common, run);
  add_clean(app, common, run);
  add_joints(app, common, run);
  add_scale(app, common, run);
  add_ik(app, common, run);
  add_track(app, common, run);
  add_analyze(app, common, run);
  add_measure(app, common, run);
  add_gait(app, common, run);
  add_emg(app, common, run);
  add_segments(app, common, run);
  add_dynamics(app, common, run);
  add_groups(app, common, run);
  add_report(app, common, run);
  add_serve(app, common, run);
  add_run(app, common, run);
  add_study(app, common, run);
  add_info(app, common, run);
  add_convert(app, common, run);
  add_validate(app, common, run);
  add_recover(app, common, run);
  add_help(app, common, run);
  add_completion(app, common, run);
  name_values(app);
}

Status check_words(const std::vector<std::string>& words) {
  CommonOptions common;
  Run run;
  CLI::App app("", "kinemark");
  add_everything(app, common, run);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    return fail(Code::usage, explain_usage(app, error, words));
  }
  return check_needs(reached(app));
}

}  // namespace kinemark::cli
