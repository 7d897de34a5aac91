// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/command.h"
#include "kinemark/pipeline/measures/measures_job.h"

namespace kinemark::cli {

/// What `analyze` takes for a recording of markers.
struct MeasuresArguments {
  pipeline::MeasuresJob job;
  double noise_mm = 0.0;
  bool list = false;  ///< tell what measures there are
  int jobs = 1;       ///< of several recordings
};

/// The options that belong to markers alone, in groups of their own.
void add_measures_options(CLI::App& command, MeasuresArguments& arguments);

/// Measure, or list; the exit status. The table goes to standard output.
[[nodiscard]] int run_measures_command(const CommonOptions& common, MeasuresArguments& arguments);

/// Measure several recordings, folders among them, into one table; the exit status, the worst of theirs.
[[nodiscard]] int run_many_measures_command(const CommonOptions& common, MeasuresArguments& arguments,
                                            const std::vector<std::filesystem::path>& inputs);

}  // namespace kinemark::cli
