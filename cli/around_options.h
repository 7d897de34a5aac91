// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include <string>

#include "cli/command.h"
#include "cli/measures_options.h"
#include "kinemark/pipeline/measures/around_job.h"

namespace kinemark::cli {

/// What `measure --around` takes besides the options of measures.
struct AroundArguments {
  pipeline::AroundJob job;
  std::string window;  ///< "FROM,TO" in s; empty: as the job has it
};

/// --around and what belongs to it.
void add_around_options(CLI::App& command, AroundArguments& arguments);

/// Average around events; the exit status. Recording options, output, refits, level and noise are those of
/// `measures`.
[[nodiscard]] int run_around_command(const CommonOptions& common, const CLI::App& command,
                                     const MeasuresArguments& measures, AroundArguments& arguments);

}  // namespace kinemark::cli
