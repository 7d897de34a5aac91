// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/dynamics_options.h"
#include "cli/heeded_options.h"
#include "cli/measures_options.h"
#include "cli/recording_options.h"

namespace kinemark::cli {
namespace {

struct Arguments {
  DynamicsArguments dynamics;
  MeasuresArguments measures;  ///< what a motion shares with markers
};

int run_command(const CommonOptions& common, const CLI::App& command, Arguments& arguments) {
  auto& job = arguments.dynamics.job;
  if (arguments.measures.list) return run_measures_command(common, command, arguments.measures);
  if (job.motion.empty() && job.setup.empty())
    return report_error(
        {.code = Code::usage, .message = "MOTION is required: .mot or .sto of coordinates, or --setup"});
  if (!job.motion.empty() && !is_motion_file(job.motion))
    return report_error(
        {.code = Code::usage,
         .message = job.motion.string() +
                    " is no motion, .mot or .sto of coordinates; 'kinemark measure', 'gait' and "
                    "'segments' take recordings of markers"});
  if (std::isnan(job.first_time_s) || std::isnan(job.last_time_s))
    return report_error({.code = Code::usage, .message = "--start and --end need a time in seconds"});
  const auto kind = is_measured(arguments.dynamics, arguments.measures.job.measures) ? AnalysisKind::motion
                                                                                     : AnalysisKind::tables;
  const auto input =
      job.motion.empty() ? std::string("the motion of the setup") : job.motion.filename().string();
  if (auto s = check_heeded(command, kind, input); !s) return report_error(s.error());
  return run_dynamics_command(common, arguments.dynamics, arguments.measures.job);
}

}  // namespace

void add_dynamics(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand(
      "dynamics", "A motion of a body model: positions and rates of bodies, torques, measures of joints");
  command->footer(
      "Ranges, peaks, power and work of joints, mass centre, stability, angular momentum "
      "(docs/stages/motion-measures.md).\nWith -o FOLDER, tables with OpenSim's names and labels: "
      "NAME_Kinematics_q, _u, _dudt.sto,\nNAME_BodyKinematics_pos, _vel, _acc_global.sto (mass centres, "
      "body-fixed X-Y-Z angles),\nNAME_PointKinematics_POINT_pos, _vel, _acc.sto, "
      "NAME_inverse_dynamics.sto, beside each its standard deviations\n(_sd.sto), and NAME_analysis.json "
      "(docs/stages/dynamics.md). Degrees, metres, seconds, N m.");
  const auto arguments = std::make_shared<Arguments>();
  auto& job = arguments->dynamics.job;
  auto& shared = arguments->measures.job;
  command->add_option("MOTION", job.motion,
                      "Coordinates, .mot or .sto, with Q_sd.sto beside it if there is one");
  add_dynamics_options(*command, arguments->dynamics);
  add_forces_option(*command, job.forces);
  command
      ->add_option("--select", shared.selection.select,
                   "Coordinates to measure, with commas between; * is any text, ? any letter")
      ->type_name("NAME")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group("Input");
  command->add_option("--start", job.first_time_s, "First time to use, s")
      ->check(finite_time)
      ->group("Input");
  command->add_option("--end", job.last_time_s, "Last time to use, s")->check(finite_time)->group("Input");
  add_measures_options(*command, arguments->measures);
  add_feet_options(*command, shared.gait);
  add_sheet_options(*command, shared.gait);
  command
      ->add_option("-o,--output", job.output,
                   "Folder for tables; or a table of measures, .csv, .json or .nwb")
      ->type_name("PATH")
      ->group("Output");
  add_cycle_options(*command, shared.gait, CyclesOf::feet);
  add_drawing_options(*command, shared, "angles, moments and powers over the gait cycle",
                      "the gait report; needs --forces FILE.c3d or .mat");
  command->callback([&common, command, arguments, &run] {
    run = [&common, command, arguments] { return run_command(common, *command, *arguments); };
  });
}

}  // namespace kinemark::cli
