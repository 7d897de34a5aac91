// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/command.h"
#include "kinemark/pipeline/measures/measures_job.h"
#include "kinemark/pipeline/motion/analysis_job.h"

namespace kinemark::cli {

/// What `analyze` takes for measures of a motion alone.
struct MotionMeasuresArguments {
  std::vector<std::string> couple;
  bool normalize = false;
};

/// These options, in a group of their own.
void add_motion_measures_options(CLI::App& command, MotionMeasuresArguments& arguments);

/// Measure the motion; the exit status. Files and range are those of `analysis`; which measures, stretches
/// and intervals those of `measures`.
[[nodiscard]] int run_motion_measures_command(const CommonOptions& common,
                                              const pipeline::AnalysisJob& analysis,
                                              const pipeline::MeasuresJob& measures,
                                              const MotionMeasuresArguments& arguments);

}  // namespace kinemark::cli
