// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/measures_options.h"

#include "cli/console.h"
#include "cli/emg_options.h"
#include "cli/gait_options.h"
#include "cli/recording_options.h"
#include "kinemark/pipeline/files/file_table.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/measures/many_measures_job.h"
#include "kinemark/pipeline/measures/measures_table.h"

namespace kinemark::cli {
namespace {

void print_measures(const CommonOptions& common, const pipeline::MeasuresOutcome& outcome) {
  for (const auto& warning : outcome.warnings) say(common, "note: " + warning);
  if (common.json)
    print_result(pipeline::json_text(pipeline::measures_outcome_json(outcome)) + "\n");
  else if (outcome.written.empty())
    print_result((outcome.gait ? pipeline::events_text(*outcome.gait) + "\n" : "") +
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

}  // namespace

void add_measures_options(CLI::App& command, MeasuresArguments& a) {
  auto& job = a.job;
  add_recording_options(command, job, pipeline::Doubtful::drop);
  const char* what = "Measures of markers";
  const auto list = [&](const char* name, auto& value, const char* type, const char* text) {
    command.add_option(name, value, text)
        ->type_name(type)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->group(what);
  };
  command.add_flag("--list", a.list, "What measures there are: formula, unit and source of each")
      ->group(what);
  list("--measures", job.measures, "NAME",
       "Which, with commas between; all that apply to each movement when absent");
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
  command.add_option("--noise", a.noise_mm, "Marker noise per axis; 0: found from the data")
      ->type_name("MM")
      ->capture_default_str()
      ->group(what);
  command.add_option("--refits", job.refits, "Simulated recordings behind each interval; 0: no intervals")
      ->type_name("N")
      ->capture_default_str()
      ->group(what);
  command.add_option("--level", job.level, "Coverage of the intervals, 0.5 to 1")
      ->type_name("SHARE")
      ->capture_default_str()
      ->group(what);
  command
      .add_option("--figures", job.figures,
                  "Folder for figures: of each path in its plane, its speed and acceleration, its cycles; of "
                  "walking, angles "
                  "over the gait cycle")
      ->type_name("FOLDER")
      ->group("Output");
  command
      .add_option("--figure-formats", job.figure_formats,
                  "svg, png or both with a comma between; what this program can write when absent")
      ->type_name("NAME")
      ->group("Output");
  command
      .add_option("--report", job.report,
                  "Page to write as well, .html: figures and tables; of walking alone, a gait report")
      ->type_name("FILE")
      ->group("Output");
  const char* several = "Several recordings";
  command
      .add_option(
          "--participants", job.participants_file,
          "Table whose columns are joined to the rows, by participant_id or by file: participants.tsv")
      ->type_name("FILE")
      ->group(several);
  command.add_option("--jobs", a.jobs, "Recordings at a time; 0: one for each core. The bits are the same.")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str()
      ->group(several);
  add_gait_options(command, job.gait);
  add_emg_options(command, job.emg);
}

int run_measures_command(const CommonOptions& common, MeasuresArguments& arguments) {
  if (arguments.list) {
    print_result(common.json ? pipeline::json_text(pipeline::measure_list_json()) + "\n"
                             : pipeline::measure_list());
    return 0;
  }
  auto& job = arguments.job;
  job.noise_sd_m = 1e-3 * arguments.noise_mm;
  return run_job(common, "markers", job, pipeline::run_measures, print_measures);
}

int run_many_measures_command(const CommonOptions& common, MeasuresArguments& arguments,
                              const std::vector<std::filesystem::path>& inputs) {
  pipeline::ManyMeasuresJob job;
  static_cast<pipeline::MeasuresJob&>(job) = arguments.job;
  job.noise_sd_m = 1e-3 * arguments.noise_mm;
  job.inputs = inputs;
  job.jobs = arguments.jobs;
  if (job.output.empty() && !job.gait.writes() && !common.json)
    return report_error(
        {.code = Code::usage,
         .message = "several recordings need a table for their measures: -o FILE.csv, .json or .nwb (or "
                    "--json, --write-events, --write-cycles)"});
  settle(common, "recordings", job);
  const auto outcome = pipeline::run_many_measures(job);
  if (!outcome) return report_error(outcome.error());
  return print_many(common, *outcome);
}

}  // namespace kinemark::cli
