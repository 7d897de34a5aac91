// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/dynamics_options.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/console.h"
#include "kinemark/core/number.h"
#include "kinemark/pipeline/body/motion_measures_job.h"
#include "kinemark/pipeline/files/info_json.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/measures/measures_table.h"

namespace kinemark::cli {
namespace {

/// NAME=BODY:X,Y,Z
Result<pipeline::AnalysisPoint> parse_point(const std::string& text) {
  const auto wrong =
      fail(Code::usage, fmt::format("'{}' is not NAME=BODY:X,Y,Z with X, Y, Z in metres", text));
  const auto equals = text.find('='), colon = text.rfind(':');
  if (equals == std::string::npos || colon == std::string::npos || equals == 0 || colon <= equals + 1)
    return wrong;
  pipeline::AnalysisPoint point{.name = text.substr(0, equals),
                                .body = text.substr(equals + 1, colon - equals - 1)};
  std::size_t begin = colon + 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto end = axis < 2 ? text.find(',', begin) : text.size();
    if (end == std::string::npos) return wrong;
    const auto value = parse_number(text.substr(begin, end - begin));
    if (!value || !std::isfinite(*value)) return wrong;
    point.x_in_body[axis] = *value;
    begin = end + 1;
  }
  return point;
}

void print_tables(const CommonOptions& common, const pipeline::AnalysisOutcome& outcome) {
  for (const auto& warning : outcome.warnings) say(common, "note: " + warning);
  say(common, fmt::format("{} rows at {:g} Hz from {:g} s.", outcome.time.frames, outcome.time.rate_hz,
                          outcome.time.t0_s));
  say_written(common, outcome);
  if (!common.json) return;
  auto json = pipeline::outcome_json(outcome);
  json["rows"] = outcome.time.frames;
  json["rate_hz"] = outcome.time.rate_hz;
  json["facts"] = nlohmann::ordered_json::object();
  for (const auto& [name, value] : outcome.facts) json["facts"][name] = value;
  print_result(json.dump(2) + "\n");
}

void print_motion_measures(const CommonOptions& common, const pipeline::MotionMeasuresOutcome& outcome) {
  for (const auto& warning : outcome.warnings) say(common, "note: " + warning);
  if (common.json)
    print_result(pipeline::json_text(pipeline::motion_measures_json(outcome)) + "\n");
  else if (outcome.written.empty())
    print_result(pipeline::measures_text(outcome.measures));
  say_written(common, outcome);
}

int run_motion_measures(const CommonOptions& common, const DynamicsArguments& arguments,
                        const pipeline::MeasuresJob& measures) {
  pipeline::MotionMeasuresJob job;
  static_cast<pipeline::MotionFiles&>(job) = arguments.job;
  static_cast<workflow::MeasureChoice&>(job) = measures;
  static_cast<pipeline::GaitOutputs&>(job) = measures;
  job.select = measures.selection.select;
  job.couple = arguments.couple;
  job.normalize = arguments.normalize;
  if (arguments.no_error_bars) job.refits = 0;
  return run_job(common, "motion", job, pipeline::run_motion_measures, print_motion_measures);
}

int run_tables(const CommonOptions& common, const DynamicsArguments& arguments) {
  auto job = arguments.job;
  job.error_bars = !arguments.no_error_bars;
  for (const auto& text : arguments.points) {
    auto point = parse_point(text);
    if (!point) return report_error(point.error());
    job.points.push_back(std::move(*point));
  }
  return run_job(common, "files", job, pipeline::run_analysis, print_tables);
}

}  // namespace

void add_dynamics_options(CLI::App& command, DynamicsArguments& a) {
  auto& job = a.job;
  command.add_option("-m,--model", job.model, "Body model, .osim; torques need masses")->group("Input");
  command
      .add_option("--setup", job.setup,
                  "OpenSim AnalyzeTool or InverseDynamicsTool setup; other options take precedence")
      ->group("Input");
  command.add_flag("--no-error-bars", a.no_error_bars, "Skip standard deviations")->group("Output");
  command.add_option("--bodies", job.bodies, "Bodies to follow, center_of_mass among them; all when absent")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group("Bodies and torques");
  command
      .add_option("--point", a.points,
                  "Point of a body to follow, in metres: heel=calcn_r:0.01,0.02,0.03. Repeatable.")
      ->type_name("NAME=BODY:X,Y,Z")
      ->allow_extra_args(false)
      ->group("Bodies and torques");
  command.add_flag("--torques", job.torques, "Inverse dynamics too (N m, N); --forces implies it")
      ->group("Bodies and torques");
  command
      .add_option(
          "--cutoff", job.cutoff_hz,
          "Low-pass of the coordinates beforehand, as OpenSim's, Hz; 0: none, each is smoothed by itself")
      ->capture_default_str()
      ->group("Bodies and torques");
  command
      .add_option("--couple", a.couple,
                  "Two coordinates whose coupling is measured: hip_flexion_r,knee_angle_r. Repeatable.")
      ->type_name("NAME,NAME")
      ->allow_extra_args(false)
      ->group("Measures");
  command
      .add_flag(
          "--normalize", a.normalize,
          "Moments, power and work to body mass; angular momentum to mass, speed and height of the mass "
          "centre")
      ->group("Measures");
}

bool is_motion_file(const std::filesystem::path& input) {
  const auto ending = pipeline::ending_of(input);
  return ending == ".mot" || ending == ".sto";
}

bool is_measured(const DynamicsArguments& arguments, const std::vector<std::string>& measures) {
  const auto& job = arguments.job;
  const auto ending = pipeline::ending_of(job.output);
  if (!job.setup.empty() || !job.bodies.empty() || !arguments.points.empty()) return false;
  return job.output.empty() || ending == ".csv" || ending == ".json" || ending == ".nwb" || !measures.empty();
}

int run_dynamics_command(const CommonOptions& common, const DynamicsArguments& arguments,
                         const pipeline::MeasuresJob& measures) {
  return is_measured(arguments, measures.measures) ? run_motion_measures(common, arguments, measures)
                                                   : run_tables(common, arguments);
}

}  // namespace kinemark::cli
