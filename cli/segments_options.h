// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/command.h"
#include "cli/measures_options.h"
#include "kinemark/pipeline/segments/segments_job.h"

namespace kinemark::cli {

/// The options of segments, in a group of their own.
/// @param definition  name of the option that gives the definition: "--definition"
void add_segments_options(CLI::App& command, pipeline::SegmentsJob& job, const std::string& definition);

/// Compute; the exit status. What segments share with measures (noise, rate, markers) is in `measures`.
[[nodiscard]] int run_segments_command(const CommonOptions& common, pipeline::SegmentsJob& job,
                                       const MeasuresArguments& measures);

}  // namespace kinemark::cli
