// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/analyze_kinds.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/many_inputs.h"
#include "cli/measures_options.h"
#include "cli/motion_measures_options.h"
#include "cli/segments_options.h"
#include "kinemark/io/number.h"
#include "kinemark/pipeline/files/outcome_json.h"
#include "kinemark/pipeline/motion/analysis_job.h"

namespace kinemark::cli {
namespace {

struct AnalyzeArguments {
  std::vector<std::filesystem::path> inputs;
  pipeline::AnalysisJob job;
  MeasuresArguments measures;
  MotionMeasuresArguments motion;
  pipeline::SegmentsJob segments;
  std::vector<std::string> points;
  bool no_error_bars = false;
};

/// A motion is a table, and only a motion has a model or a setup; all else is markers.
bool is_of_markers(const AnalyzeArguments& arguments) {
  const auto& job = arguments.job;
  if (arguments.measures.list) return true;
  const auto ending = pipeline::ending_of(job.motion);
  return !job.motion.empty() && job.model.empty() && job.setup.empty() && ending != ".mot" &&
         ending != ".sto";
}

/// Tables of the motion go into a folder; without one, or into one file, go measures.
bool is_measured(const AnalyzeArguments& arguments) {
  const auto& job = arguments.job;
  const auto ending = pipeline::ending_of(job.output);
  if (!job.setup.empty() || !job.bodies.empty() || !arguments.points.empty()) return false;
  return job.output.empty() || ending == ".csv" || ending == ".json" || ending == ".nwb" ||
         !arguments.measures.job.measures.empty();
}

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
    const auto value = io::parse_number(text.substr(begin, end - begin));
    if (!value || !std::isfinite(*value)) return wrong;
    point.x_in_body[axis] = *value;
    begin = end + 1;
  }
  return point;
}

void print_outcome(const CommonOptions& common, const pipeline::AnalysisOutcome& outcome) {
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

AnalyzeKind kind_of(const AnalyzeArguments& arguments) {
  if (arguments.measures.list) return AnalyzeKind::list;
  if (are_many(arguments.inputs)) return AnalyzeKind::several;
  if (!arguments.segments.definition.empty()) return AnalyzeKind::segments;
  if (is_of_markers(arguments)) return AnalyzeKind::markers;
  return is_measured(arguments) ? AnalyzeKind::motion : AnalyzeKind::tables;
}

Status check_no_motion(const std::vector<std::filesystem::path>& inputs) {
  for (const auto& input : inputs)
    if (const auto ending = pipeline::ending_of(input); ending == ".mot" || ending == ".sto")
      return fail(Code::usage,
                  fmt::format("{}: is a motion; several recordings are of markers", input.string()));
  return {};
}

int run_several(const CommonOptions& common, AnalyzeArguments& arguments) {
  if (auto s = check_no_motion(arguments.inputs); !s) return report_error(s.error());
  return run_many_measures_command(common, arguments.measures, arguments.inputs);
}

int run_segments(const CommonOptions& common, AnalyzeArguments& arguments) {
  arguments.segments.input = arguments.job.motion;
  arguments.segments.output = arguments.measures.job.output;
  return run_segments_command(common, arguments.segments, arguments.measures);
}

int run_tables(const CommonOptions& common, const AnalyzeArguments& arguments) {
  auto job = arguments.job;
  for (const auto& text : arguments.points) {
    auto point = parse_point(text);
    if (!point) return report_error(point.error());
    job.points.push_back(std::move(*point));
  }
  return run_job(common, "files", job, pipeline::run_analysis, print_outcome);
}

/// What the command line gives once, where each job has it.
void share(AnalyzeArguments& arguments) {
  auto& job = arguments.job;
  if (!arguments.inputs.empty()) job.motion = arguments.measures.job.input = arguments.inputs.front();
  arguments.measures.job.output = job.output;
  arguments.measures.job.forces = arguments.segments.forces = job.forces;
  const auto& times = arguments.measures.job.selection;
  if (std::isfinite(times.first_time_s)) job.first_time_s = times.first_time_s;
  if (std::isfinite(times.last_time_s)) job.last_time_s = times.last_time_s;
  job.error_bars = !arguments.no_error_bars;
}

int run_command(const CommonOptions& common, const CLI::App& command, AnalyzeArguments& arguments) {
  share(arguments);
  const auto kind = kind_of(arguments);
  const auto input = arguments.inputs.empty() ? std::string("the motion of the setup")
                                              : arguments.inputs.front().filename().string();
  if (auto s = check_heeded(command, kind, input); !s) return report_error(s.error());
  switch (kind) {
    case AnalyzeKind::list:
    case AnalyzeKind::markers:
      return run_measures_command(common, arguments.measures);
    case AnalyzeKind::several:
      return run_several(common, arguments);
    case AnalyzeKind::segments:
      return run_segments(common, arguments);
    case AnalyzeKind::motion:
      return run_motion_measures_command(common, arguments.job, arguments.measures.job, arguments.motion);
    case AnalyzeKind::tables:
      return run_tables(common, arguments);
  }
  return report_error({.code = Code::usage, .message = "nothing to analyse"});
}

void add_options(CLI::App& command, AnalyzeArguments& a) {
  auto& job = a.job;
  command.add_option(
      "IN", a.inputs,
      "Markers, whose paths are measured: a recording, several, or a folder of them; or a motion: .mot "
      "or .sto of coordinates, with Q_sd.sto beside it if there is one");
  command.add_option("-m,--model", job.model, "Body model, .osim; torques need masses")->group("Input");
  command
      .add_option(
          "--forces", job.forces,
          "Forces on the body, for torques, steps and moments, instead of a recording's own plates: .c3d "
          "or .mat with force plates, .mot or .sto with columns such as ground_force_vx, or OpenSim "
          "ExternalLoads .xml")
      ->group("Input");
  command
      .add_option("--setup", job.setup,
                  "OpenSim AnalyzeTool or InverseDynamicsTool setup; other options take precedence")
      ->group("Input");
  command
      .add_option("-o,--output", job.output,
                  "Folder for the results; for measures a table, .csv, .json or .nwb")
      ->type_name("PATH")
      ->group("Output");
  command.add_flag("--no-error-bars", a.no_error_bars, "Skip standard deviations")->group("Output");
  command.add_option("--bodies", job.bodies, "Bodies to follow, center_of_mass among them; all when absent")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group("What");
  command
      .add_option("--point", a.points,
                  "Point of a body to follow, in metres: heel=calcn_r:0.01,0.02,0.03. Repeatable.")
      ->type_name("NAME=BODY:X,Y,Z")
      ->allow_extra_args(false)
      ->group("What");
  command.add_flag("--torques", job.torques, "Inverse dynamics too (N m, N); --forces implies it")
      ->group("What");
  command
      .add_option(
          "--cutoff", job.cutoff_hz,
          "Low-pass of the coordinates beforehand, as OpenSim's, Hz; 0: none, each is smoothed by itself")
      ->capture_default_str()
      ->group("Rates");
}

}  // namespace

void add_analyze(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand(
      "analyze",
      "Measures of markers' paths with intervals; what bodies do along a motion: positions, rates, torques");
  command->footer(
      "Of a recording of markers: shape, timing and smoothness of each path, freed of the bias of noise, "
      "with 95 % "
      "intervals\n(docs/stages/measures.md); --list tells what there is. Of several recordings, or of a "
      "folder of them, in one "
      "table\n(docs/stages/many-recordings.md).\nWith --segments: joint centres and "
      "angles by a definition "
      "(docs/stages/segments.md).\nOf a motion with --model: ranges, peaks, power and work of joints, "
      "mass centre, stability, angular momentum (docs/stages/motion-measures.md).\nWith a folder: writes "
      "into "
      "it, with OpenSim's names and labels: NAME_Kinematics_q, _u, _dudt.sto, "
      "NAME_BodyKinematics_pos,\n_vel, _acc_global.sto (mass centres, body-fixed X-Y-Z angles), "
      "NAME_PointKinematics_POINT_pos, _vel, _acc.sto,\nNAME_inverse_dynamics.sto, beside each its standard "
      "deviations (_sd.sto), and NAME_analysis.json. Degrees, metres, seconds, N m.");
  const auto arguments = std::make_shared<AnalyzeArguments>();
  add_options(*command, *arguments);
  add_measures_options(*command, arguments->measures);
  add_motion_measures_options(*command, arguments->motion);
  add_segments_options(*command, arguments->segments);
  command->callback([&common, command, arguments, &run] {
    run = [&common, command, arguments] { return run_command(common, *command, *arguments); };
  });
}

}  // namespace kinemark::cli
