// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

#include "kinemark/pipeline/measures/gait_request.h"

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

}  // namespace kinemark::cli
