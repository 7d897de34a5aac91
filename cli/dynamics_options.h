// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/measures_options.h"
#include "kinemark/pipeline/motion/analysis_job.h"

namespace kinemark::cli {

/// What commands take for a motion.
struct DynamicsArguments {
  pipeline::AnalysisJob job;
  std::vector<std::string> points;  ///< NAME=BODY:X,Y,Z
  std::vector<std::string> couple;  ///< NAME,NAME
  bool normalize = false;
  bool no_error_bars = false;
};

/// The options that only a motion has.
void add_dynamics_options(CLI::App& command, DynamicsArguments& arguments);

/// Whether the file is a motion, a table of coordinates, by its name.
[[nodiscard]] bool is_motion_file(const std::filesystem::path& input);

/// Whether measures are asked for, not tables in a folder: these have an output without an ending of a table
/// of measures, bodies or points to follow, or a setup of OpenSim's.
[[nodiscard]] bool is_measured(const DynamicsArguments& arguments, const std::vector<std::string>& measures);

/// Measure the motion, or write its tables; the exit status. Input, output, forces and times are those of
/// `arguments`; measures, spans, intervals, coordinates and walking those of `measures`.
[[nodiscard]] int run_dynamics_command(const CommonOptions& common, const DynamicsArguments& arguments,
                                       const pipeline::MeasuresJob& measures);

}  // namespace kinemark::cli
