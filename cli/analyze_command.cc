// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <string>
#include <string_view>

#include "cli/command.h"
#include "cli/command_tree.h"
#include "cli/console.h"
#include "cli/dynamics_options.h"
#include "cli/heeded_options.h"
#include "cli/many_inputs.h"
#include "cli/measures_options.h"
#include "cli/option_needs.h"
#include "cli/recording_options.h"
#include "cli/segments_options.h"
#include "cli/word_list.h"

namespace kinemark::cli {
namespace {

/// Options that the help shows; those of one kind of analysis alone are shown by its own command.
constexpr std::string_view kShown =
    "IN list rate edits select drop rename frames start end up rotate doubtful model forces output figures "
    "report help";

struct AnalyzeArguments {
  MeasuresArguments measures;
  DynamicsArguments dynamics;
  pipeline::SegmentsJob segments;
};

/// A motion is a table, and only a motion has a model or a setup; all else is markers.
bool is_of_markers(const DynamicsArguments& motion) {
  const auto& job = motion.job;
  return !job.motion.empty() && job.model.empty() && job.setup.empty() && !is_motion_file(job.motion);
}

AnalysisKind kind_of(const AnalyzeArguments& arguments) {
  if (arguments.measures.list) return AnalysisKind::list;
  if (are_many(arguments.measures.inputs)) return AnalysisKind::several;
  if (!arguments.segments.definition.empty()) return AnalysisKind::segments;
  if (is_of_markers(arguments.dynamics)) return AnalysisKind::markers;
  return is_measured(arguments.dynamics, arguments.measures.job.measures) ? AnalysisKind::motion
                                                                          : AnalysisKind::tables;
}

/// What the command line gives once, where each job has it.
void share(AnalyzeArguments& arguments) {
  auto& measures = arguments.measures.job;
  auto& motion = arguments.dynamics.job;
  auto& segments = arguments.segments;
  const auto& inputs = arguments.measures.inputs;
  if (!inputs.empty()) motion.motion = segments.input = inputs.front();
  motion.output = segments.output = measures.output;
  motion.forces = segments.forces = measures.forces;
  const auto& times = measures.selection;
  if (std::isfinite(times.first_time_s)) motion.first_time_s = times.first_time_s;
  if (std::isfinite(times.last_time_s)) motion.last_time_s = times.last_time_s;
}

/// What the command that does the work needs beside its options.
Status check_needs_of_kind(AnalysisKind kind, const CLI::App& command) {
  if (kind == AnalysisKind::segments) return check_needs_of("segments", command);
  if (kind == AnalysisKind::motion || kind == AnalysisKind::tables)
    return check_needs_of("dynamics", command);
  return {};
}

/// A sentence, where the command did its work; its exit status.
int said(const CommonOptions& common, const char* sentence, int status) {
  if (status <= 1) say(common, sentence);
  return status;
}

int run_command(const CommonOptions& common, const CLI::App& command, AnalyzeArguments& arguments) {
  share(arguments);
  const auto& times = arguments.measures.job.selection;
  if (std::isnan(times.first_time_s) || std::isnan(times.last_time_s))
    return report_error({.code = Code::usage, .message = "--start and --end: no time lies between them"});
  const auto& inputs = arguments.measures.inputs;
  const auto kind = kind_of(arguments);
  const auto input =
      inputs.empty() ? std::string("the motion of the setup") : inputs.front().filename().string();
  if (auto s = check_heeded(command, kind, input); !s) return report_error(s.error());
  if (auto s = check_needs_of_kind(kind, command); !s) return report_error(s.error());
  switch (kind) {
    case AnalysisKind::list:
    case AnalysisKind::markers:
    case AnalysisKind::several:
      return run_measures_command(common, command, arguments.measures);
    case AnalysisKind::segments:
      return said(common, "This is 'kinemark segments'.",
                  run_segments_command(common, arguments.segments, arguments.measures));
    case AnalysisKind::motion:
    case AnalysisKind::tables:
      return said(common, "This is 'kinemark dynamics'.",
                  run_dynamics_command(common, arguments.dynamics, arguments.measures.job));
    case AnalysisKind::around:  // of measure alone
    case AnalysisKind::around_motion:
      break;
  }
  return report_error({.code = Code::usage, .message = "nothing to analyse"});
}

void add_options(CLI::App& command, AnalyzeArguments& arguments) {
  auto& job = arguments.measures.job;
  command.add_option("IN", arguments.measures.inputs,
                     "A recording of markers, several, or a folder of them; or a motion, .mot or .sto");
  add_recording_options(command, job, pipeline::Doubtful::drop);
  add_dynamics_options(command, arguments.dynamics);
  add_forces_option(command, job.forces);
  add_segments_options(command, arguments.segments, "--segments");
  add_feet_options(command, job.gait, true);
  add_angles_option(command, job.gait);
  add_sheet_options(command, job.gait);
  add_emg_options(command, job.emg, kSharedEmgNames);
  add_measures_options(command, arguments.measures);
  add_noise_option(command, arguments.measures.noise_mm);
  command
      .add_option("-o,--output", job.output,
                  "Table of the measures, .csv, .json or .nwb; of a motion also a folder for its tables")
      ->type_name("PATH")
      ->group("Output");
  add_cycle_options(command, job.gait, CyclesOf::either);
  add_drawing_options(command, job, "paths, angles over the gait cycle",
                      "figures and tables; of walking alone, a gait report");
  add_several_options(command, arguments.measures);
  for (CLI::Option* option : command.get_options())
    if (!has_word(kShown, option->get_lnames().empty() ? option->get_name() : option->get_lnames().front()))
      option->group(kExplainedElsewhere);
}

}  // namespace

void add_analyze(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command =
      app.add_subcommand("analyze", "All that a recording or a motion shows, and which command shows it");
  command->footer(
      "For those who do not know which command it is. Walking and force plates are measured by 'gait', paths "
      "of "
      "markers by\n'measure', electromyograms by 'emg', angles of segments by 'segments', motions of a body "
      "model by "
      "'dynamics'.\nTheir options are taken here too (docs/stages/analyze.md).");
  const auto arguments = std::make_shared<AnalyzeArguments>();
  add_options(*command, *arguments);
  command->callback([&common, command, arguments, &run] {
    run = [&common, command, arguments] { return run_command(common, *command, *arguments); };
  });
}

}  // namespace kinemark::cli
