// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The options of `kinemark ik` for inertial sensors in place of markers, or beside them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/command.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/motion/orientation_job.h"

namespace kinemark::cli {

/// Options in the units of the command line.
struct OrientationArguments {
  pipeline::OrientationJob job;
  std::vector<std::string> sensors;
  std::string heading;
  double noise_deg = 0.0, max_rms_deg = 10.0;

  /// Whether sensors are asked for.
  [[nodiscard]] bool any() const { return !job.orientations.empty(); }
};

/// The options, in a group of their own.
void add_orientation_options(CLI::App& command, OrientationArguments& a);

/// Sensors beside the markers of a job.
[[nodiscard]] Status add_sensors(const OrientationArguments& a, pipeline::IkJob& job);
/// Says how they fit, in two lines.
void say_sensors(const CommonOptions& common, const motion::OrientationFit& fit);

/// Solves them alone, with what `markers` says of model, output, times, vertical, limits and error bars.
[[nodiscard]] int run_orientation_command(const CommonOptions& common, OrientationArguments& a,
                                          const pipeline::IkJob& markers);

}  // namespace kinemark::cli
