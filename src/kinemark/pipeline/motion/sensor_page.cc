// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/internal/sensor_page.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/core/version.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"
#include "kinemark/pipeline/motion/internal/sensor_run.h"
#include "kinemark/pipeline/motion/model_meshes.h"
#include "kinemark/stages/report/ik_report.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline::internal {
namespace {

report::IkRun describe_run(const OrientationJob& job, const model::Model& model,
                           const OrientationOutcome& outcome) {
  const auto& description = model.description();
  const auto& fit = outcome.result.fit;
  report::IkRun run;
  run.trial = job.orientations.filename().string();
  run.model = outcome.model;
  run.method = "least squares from inertial sensors";
  run.version = kVersion;
  run.command_line = outcome.command_line;
  run.seed = job.seed;
  run.threads = job.threads;
  run.exit_status = outcome.exit_status();
  run.solve_s = outcome.result.solve_seconds;
  run.options = sensor_facts(fit, job);
  run.options.emplace_back("limits of clamped coordinates", job.options.limits ? "kept" : "ignored");
  run.inputs = outcome.inputs;
  run.gates = outcome.gates;
  run.warnings = outcome.warnings;
  run.by_sensors = true;
  // Orientations say nothing of positions: these stay at their defaults.
  run.locked_coordinates = fit.at_default;
  double mass_kg = 0.0;
  for (const auto& body : description.bodies) mass_kg += body.mass;
  if (mass_kg > 0.0) run.mass_kg = mass_kg;
  for (const auto& coordinate : description.coordinates) {
    if (std::ranges::find(fit.at_default, coordinate.name) != fit.at_default.end()) continue;
    if (coordinate.locked)
      run.locked_coordinates.push_back(coordinate.name);
    else if (coordinate.clamped && !coordinate.prescribed)
      run.limits.push_back({coordinate.name, coordinate.range_min, coordinate.range_max});
  }
  return run;
}

}  // namespace

Result<std::string> sensor_page(const OrientationJob& job, const model::Model& model,
                                const OrientationOutcome& outcome) {
  const auto& motion = outcome.result.motion;
  auto summary = report::summarize(describe_run(job, model, outcome), motion, nullptr);
  if (!summary) return std::unexpected(summary.error());
  const auto bodies =
      body_positions(model, motion, read_model_meshes(job.model, model.description(), job.geometry));
  const auto sensors = page_sensors(motion.time, outcome.result.fit, outcome.result.error_rad);
  return report::report_html({.summary = std::move(*summary),
                              .motion = &motion,
                              .up = workflow::up_of(model),
                              .sensors = &sensors,
                              .bodies = &bodies});
}

}  // namespace kinemark::pipeline::internal
