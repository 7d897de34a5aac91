// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/command.h"
#include "kinemark/pipeline/measures/emg_request.h"
#include "kinemark/pipeline/measures/gait_request.h"
#include "kinemark/pipeline/measures/measures_job.h"

namespace kinemark::cli {

/// Whose events of feet, and which markers are on them.
/// @param movements  whether events may be those of the markers' own movements instead
void add_feet_options(CLI::App& command, pipeline::GaitRequest& request, bool movements = false);
/// Whose events and cycles are written.
enum class CyclesOf : std::uint8_t { feet, movements, either };

/// Files of events and cycles.
void add_cycle_options(CLI::App& command, pipeline::GaitRequest& request, CyclesOf of);
/// The motion whose coordinates are cut into cycles.
void add_angles_option(CLI::App& command, pipeline::GaitRequest& request);
/// Norms, and pairs of curves.
void add_sheet_options(CLI::App& command, pipeline::GaitRequest& request);

/// What the options for electromyograms are called.
struct EmgNames {
  std::string channels, prefix, write, write_cycles;
};

/// Of `kinemark emg`, and of `analyze`, where others stand beside them.
inline const EmgNames kOwnEmgNames{"--channels", "--", "--write-envelopes", "--write-cycles"};
inline const EmgNames kSharedEmgNames{"--emg", "--emg-", "--write-emg", "--write-emg-cycles"};

/// The options for electromyograms, in a group of their own.
void add_emg_options(CLI::App& command, pipeline::EmgRequest& request, const EmgNames& names);

/// What commands take that measure a recording of markers.
struct MeasuresArguments {
  std::vector<std::filesystem::path> inputs;
  pipeline::MeasuresJob job;
  double noise_mm = 0.0;
  bool list = false;  ///< print what measures there are
  int jobs = 1;       ///< of several recordings
};

/// Which measures, over which spans, with which intervals; --list.
void add_measures_options(CLI::App& command, MeasuresArguments& arguments);
/// --refits and --level.
void add_interval_options(CLI::App& command, workflow::MeasureChoice& choice);
/// --noise of markers.
void add_noise_option(CLI::App& command, double& noise_mm);
/// The forces on the body from another file than the recording.
void add_forces_option(CLI::App& command, std::filesystem::path& forces);
/// Figures and page.
/// @param figures  what is drawn
/// @param page     what the page shows
void add_drawing_options(CLI::App& command, pipeline::GaitOutputs& outputs, const std::string& figures,
                         const std::string& page);
/// What several recordings in one table have.
void add_several_options(CLI::App& command, MeasuresArguments& arguments);

/// Measure one recording or several, folders among them, or list measures; the exit status. Refuses options
/// that are not heeded of what is given, and motions. A table that goes nowhere else goes to standard output.
[[nodiscard]] int run_measures_command(const CommonOptions& common, const CLI::App& command,
                                       MeasuresArguments& arguments);

}  // namespace kinemark::cli
