// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/measures_options.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>

#include "cli/console.h"
#include "cli/dynamics_options.h"
#include "cli/heeded_options.h"
#include "cli/many_inputs.h"
#include "kinemark/data/interval_refits.h"
#include "kinemark/pipeline/files/file_table.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/measures/many_measures_job.h"
#include "kinemark/pipeline/measures/measures_table.h"

namespace kinemark::cli {
namespace {

constexpr const char* kWalking = "Walking";

void print_measures(const CommonOptions& common, const pipeline::MeasuresOutcome& outcome, bool events) {
  for (const auto& warning : outcome.warnings) say(common, "note: " + warning);
  if (common.json)
    print_result(pipeline::json_text(pipeline::measures_outcome_json(outcome)) + "\n");
  else if (outcome.written.empty())
    print_result((outcome.gait && events ? pipeline::events_text(*outcome.gait) + "\n" : "") +
                 (outcome.rhythms.empty() ? "" : pipeline::rhythms_text(outcome.rhythms) + "\n") +
                 pipeline::measures_text(outcome.measures));
  say_written(common, outcome);
}

int print_many(const CommonOptions& common, const pipeline::ManyMeasuresOutcome& outcome) {
  for (const auto& note : outcome.notes) say(common, "note: " + note);
  for (const auto& trial : outcome.trials)
    if (trial.status == pipeline::TrialStatus::failed)
      (void)report_error({.code = Code::bad_input, .message = trial.said});
  if (common.json)
    print_result(pipeline::json_text(pipeline::many_measures_json(outcome)) + "\n");
  else if (!common.quiet)
    print_result(pipeline::trial_table(outcome));
  for (const auto& path : outcome.written) say(common, fmt::format("wrote {}", path.string()));
  return outcome.exit_status();
}

Status check_no_motion(const std::vector<std::filesystem::path>& inputs) {
  for (const auto& input : inputs)
    if (is_motion_file(input))
      return fail(Code::usage,
                  fmt::format("{} is a motion, no recording of markers; 'kinemark dynamics' measures it",
                              input.string()));
  return {};
}

int run_one(const CommonOptions& common, MeasuresArguments& arguments) {
  if (auto s = check_no_motion(arguments.inputs); !s) return report_error(s.error());
  auto& job = arguments.job;
  job.input = arguments.inputs.front();
  job.noise_sd_m = 1e-3 * arguments.noise_mm;
  return run_job(common, "markers", job, pipeline::run_measures,
                 [&job](const CommonOptions& options, const pipeline::MeasuresOutcome& outcome) {
                   const auto commands = pipeline::commands_for(outcome);
                   if (job.of == workflow::MeasuresOf::everything && !commands.empty())
                     say(options, fmt::format("This is {}.", commands));
                   print_measures(options, outcome, job.of != workflow::MeasuresOf::muscles);
                 });
}

int run_many(const CommonOptions& common, MeasuresArguments& arguments) {
  if (auto s = check_no_motion(arguments.inputs); !s) return report_error(s.error());
  pipeline::ManyMeasuresJob job;
  static_cast<pipeline::MeasuresJob&>(job) = arguments.job;
  job.noise_sd_m = 1e-3 * arguments.noise_mm;
  job.inputs = arguments.inputs;
  job.jobs = arguments.jobs;
  if (job.output.empty() && !job.gait.writes() && !common.json)
    return report_error(
        {.code = Code::usage,
         .message =
             "several recordings need a table for their measures: -o FILE.csv, .json or .nwb (or --json)"});
  settle(common, "recordings", job);
  const auto outcome = pipeline::run_many_measures(job);
  if (!outcome) return report_error(outcome.error());
  if (job.of == workflow::MeasuresOf::everything)
    say(common, "This is what 'kinemark gait', 'kinemark emg' and 'kinemark measure' show of each.");
  return print_many(common, *outcome);
}

}  // namespace

void add_feet_options(CLI::App& command, pipeline::GaitRequest& request, bool movements) {
  std::string text = "Whose events of feet: best (plates, else markers), plates, kinematics, file";
  if (movements) text += "; or movement: of each marker's own movement";
  command.add_option("--events", request.events, text)
      ->type_name("WHOSE")
      ->capture_default_str()
      ->group(kWalking);
  command
      .add_option(
          "--gait-marker", request.markers,
          "A marker under a name of its own: left_heel=L_FCC (left_, right_: heel, toe, ankle; sacrum); or a "
          ".toml of such lines. Repeatable.")
      ->type_name("ROLE=NAME")
      ->allow_extra_args(false)
      ->group(kWalking);
}

void add_cycle_options(CLI::App& command, pipeline::GaitRequest& request, CyclesOf of) {
  const char *events = "Foot strikes and foot offs", *cycles = "Angles over each stride and their mean";
  if (of == CyclesOf::movements) {
    events = "Starts and ends of movements and cycles";
    cycles = "Places and speeds over each repetition and their mean";
  } else if (of == CyclesOf::either) {
    events = "Foot strikes and foot offs, or starts and ends of movements and cycles where no foot steps";
    cycles =
        "Angles over each stride and their mean; where no foot steps, places and speeds over each repetition";
  }
  command
      .add_option("--write-events", request.write_events,
                  fmt::format("{}: .csv, or .c3d or .nwb, the recording with these events", events))
      ->type_name("FILE")
      ->group("Output");
  command.add_option("--write-cycles", request.write_cycles, fmt::format("{}, 0 to 100 %, .csv", cycles))
      ->type_name("FILE")
      ->group("Output");
}

void add_angles_option(CLI::App& command, pipeline::GaitRequest& request) {
  command
      .add_option("--angles", request.angles,
                  "Motion whose coordinates are cut into cycles, .mot or .sto; Q_sd.sto beside it counts too")
      ->type_name("FILE")
      ->group(kWalking);
}

void add_sheet_options(CLI::App& command, pipeline::GaitRequest& request) {
  command
      .add_option(
          "--norm", request.sheet.norms,
          "Bands to draw in grey and to compare with, .csv: of curves as 'groups band' writes them, of "
          "measures. Repeatable.")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group(kWalking);
  command
      .add_option(
          "--angle-angle", request.sheet.angle_angle,
          "Two curves to draw against each other: hip_flexion:knee_flexion, across and up. Repeatable; hip "
          "and knee, knee and ankle when absent")
      ->type_name("A:B")
      ->allow_extra_args(false)
      ->group(kWalking);
}

void add_emg_options(CLI::App& command, pipeline::EmgRequest& request, const EmgNames& names) {
  const char* what = "Electromyograms";
  command
      .add_option(names.channels, request.channels,
                  "Analog channels that hold EMG, with commas between; * is any text; found by their names "
                  "when absent")
      ->type_name("NAME")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(what);
  const auto number = [&](const std::string& name, double& value, const char* unit, const char* text) {
    command.add_option(names.prefix + name, value, text)->type_name(unit)->capture_default_str()->group(what);
  };
  number("high-pass", request.envelope.high_pass_hz, "HZ", "Lower end of the band; 0: none");
  number("low-pass", request.envelope.low_pass_hz, "HZ", "Upper end of the band");
  number("envelope", request.envelope.envelope_hz, "HZ", "Low-pass of the rectified signal");
  number("rms", request.envelope.rms_window_s, "S", "Root mean square of this long instead; 0: none");
  command
      .add_option(
          names.prefix + "max", request.maximum,
          "What 100 % is: trial, the largest envelope of the recording; or a .c3d of maximal contractions")
      ->type_name("trial|FILE")
      ->group(what);
  command.add_option(names.write, request.write, "Envelopes at the frames of the recording, .sto or .csv")
      ->type_name("FILE")
      ->group(what);
  command
      .add_option(names.write_cycles, request.write_cycles,
                  "Envelopes over each cycle of walking and their mean, 0 to 100 %, .csv")
      ->type_name("FILE")
      ->group(what);
}

void add_measures_options(CLI::App& command, MeasuresArguments& a) {
  auto& job = a.job;
  const char* what = "Measures";
  command.add_flag("--list", a.list, "What measures there are: formula, unit and source of each")
      ->group(what);
  command
      .add_option("--measures", job.measures,
                  "Which, with commas between; all that apply to each movement when absent")
      ->type_name("NAME")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(what);
  command
      .add_option("--region", job.regions,
                  "A span to measure: reach=120-300 in frames, reach=1.2s-3s. Repeatable.")
      ->type_name("NAME=FIRST-LAST")
      ->allow_extra_args(false)
      ->group(what);
  command
      .add_option("--between", job.between, "Spans from each event of this label to the next. Repeatable.")
      ->type_name("LABEL")
      ->allow_extra_args(false)
      ->group(what);
  add_interval_options(command, job);
}

void add_interval_options(CLI::App& command, workflow::MeasureChoice& choice) {
  const auto* refits =
      command
          .add_option("--refits", choice.refits,
                      "Simulated recordings behind each interval, more where --level needs them; 0: no "
                      "intervals")
          ->type_name("N")
          ->capture_default_str()
          ->group("Measures");
  // What is given of both is known once all words are read.
  const auto take_level = [&choice, refits](const double& level) {
    choice.level = level;
    if (refits->count() == 0) choice.refits = std::max(choice.refits, data::least_refits(level));
  };
  command
      .add_option_function<double>("--level", take_level, "Coverage of the intervals, above 0.5 to 0.9999")
      ->default_str(fmt::format("{:g}", choice.level))
      ->type_name("SHARE")
      ->group("Measures");
}

void add_noise_option(CLI::App& command, double& noise_mm) {
  command.add_option("--noise", noise_mm, "Marker noise per axis; 0: found from the data")
      ->type_name("MM")
      ->capture_default_str()
      ->group("Measures");
}

void add_forces_option(CLI::App& command, std::filesystem::path& forces) {
  command
      .add_option(
          "--forces", forces,
          "Forces on the body, for torques, steps and moments, instead of a recording's own plates: .c3d "
          "or .mat with force plates, .mot or .sto with columns such as ground_force_vx, .txt of D-Flow, or "
          "OpenSim ExternalLoads .xml")
      ->group("Input");
}

void add_drawing_options(CLI::App& command, pipeline::GaitOutputs& outputs, const std::string& figures,
                         const std::string& page) {
  auto* folder = command.add_option("--figures", outputs.figures, "Folder for figures: " + figures)
                     ->type_name("FOLDER")
                     ->group("Output");
  command
      .add_option("--figure-formats", outputs.figure_formats,
                  "svg, png or both with a comma between; what this program can write when absent")
      ->type_name("NAME")
      ->needs(folder)
      ->group("Output");
  command.add_option("--report", outputs.report, "Page to write as well, .html: " + page)
      ->type_name("FILE")
      ->group("Output");
}

void add_several_options(CLI::App& command, MeasuresArguments& a) {
  const char* several = "Several recordings";
  command
      .add_option(
          "--participants", a.job.participants_file,
          "Table whose columns are joined to the rows, by participant_id or by file: participants.tsv")
      ->type_name("FILE")
      ->group(several);
  command.add_option("--jobs", a.jobs, "Recordings at a time; 0: one for each core. The bits are the same.")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str()
      ->group(several);
}

int run_measures_command(const CommonOptions& common, const CLI::App& command, MeasuresArguments& arguments) {
  const auto& inputs = arguments.inputs;
  if (inputs.empty() && !arguments.list)
    return report_error({.code = Code::usage, .message = "IN is required: a recording of markers"});
  const bool many = are_many(inputs);
  const auto kind = arguments.list ? AnalysisKind::list
                    : many         ? AnalysisKind::several
                                   : AnalysisKind::markers;
  if (auto s = check_heeded(command, kind, inputs.empty() ? "" : inputs.front().filename().string()); !s)
    return report_error(s.error());
  if (!arguments.list) return many ? run_many(common, arguments) : run_one(common, arguments);
  print_result(common.json ? pipeline::json_text(pipeline::measure_list_json(arguments.job.of)) + "\n"
                           : pipeline::measure_list(arguments.job.of));
  return 0;
}

}  // namespace kinemark::cli
