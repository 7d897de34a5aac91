// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace kinemark::cli {

/// Options that every command takes.
struct CommonOptions {
  int threads = 0;
  std::uint64_t seed = 1;
  bool force = false;
  bool quiet = false;
  bool json = false;
  std::string config;                       ///< file of options, which are among the words by then
  std::string save_config;                  ///< file for the options; empty: none
  std::vector<std::string> reads;           ///< files_read() of the command that started this one
  std::string command_line;                 ///< as typed, with what --config put in
  std::vector<std::filesystem::path> kept;  ///< files_read() and that of --config: never replaced
};

/// A command adds itself to the program and stores its action in `run`, which returns the exit status.
using Run = std::function<int()>;

void add_acquire(CLI::App& app, const CommonOptions& common, Run& run);
void add_calibrate(CLI::App& app, const CommonOptions& common, Run& run);
void add_reconstruct(CLI::App& app, const CommonOptions& common, Run& run);
void add_study(CLI::App& app, const CommonOptions& common, Run& run);
void add_info(CLI::App& app, const CommonOptions& common, Run& run);
void add_clean(CLI::App& app, const CommonOptions& common, Run& run);
void add_edit(CLI::App& app, const CommonOptions& common, Run& run);
void add_convert(CLI::App& app, const CommonOptions& common, Run& run);
void add_validate(CLI::App& app, const CommonOptions& common, Run& run);
void add_simulate(CLI::App& app, const CommonOptions& common, Run& run);
void add_simulate_limb(CLI::App& simulate, const CommonOptions& common, Run& run);
void add_simulate_rig(CLI::App& simulate, const CommonOptions& common, Run& run);
void add_ik(CLI::App& app, const CommonOptions& common, Run& run);
void add_analyze(CLI::App& app, const CommonOptions& common, Run& run);
void add_measure(CLI::App& app, const CommonOptions& common, Run& run);
void add_gait(CLI::App& app, const CommonOptions& common, Run& run);
void add_emg(CLI::App& app, const CommonOptions& common, Run& run);
void add_segments(CLI::App& app, const CommonOptions& common, Run& run);
void add_dynamics(CLI::App& app, const CommonOptions& common, Run& run);
void add_groups(CLI::App& app, const CommonOptions& common, Run& run);
void add_track(CLI::App& app, const CommonOptions& common, Run& run);
void add_joints(CLI::App& app, const CommonOptions& common, Run& run);
void add_recover(CLI::App& app, const CommonOptions& common, Run& run);
void add_run(CLI::App& app, const CommonOptions& common, Run& run);
void add_report(CLI::App& app, const CommonOptions& common, Run& run);
void add_help(CLI::App& app, const CommonOptions& common, Run& run);
void add_completion(CLI::App& app, const CommonOptions& common, Run& run);
void add_scale(CLI::App& app, const CommonOptions& common, Run& run);
void add_serve(CLI::App& app, const CommonOptions& common, Run& run);

}  // namespace kinemark::cli
