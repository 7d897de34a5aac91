// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/motion_measures_options.h"

#include "cli/console.h"
#include "kinemark/pipeline/body/motion_measures_job.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/measures/measures_table.h"

namespace kinemark::cli {
namespace {

void print_motion_measures(const CommonOptions& common, const pipeline::MotionMeasuresOutcome& outcome) {
  for (const auto& warning : outcome.warnings) say(common, "note: " + warning);
  if (common.json)
    print_result(pipeline::json_text(pipeline::motion_measures_json(outcome)) + "\n");
  else if (outcome.written.empty())
    print_result(pipeline::measures_text(outcome.measures));
  say_written(common, outcome);
}

}  // namespace

void add_motion_measures_options(CLI::App& command, MotionMeasuresArguments& a) {
  const char* what = "Measures of a motion";
  command
      .add_option("--couple", a.couple,
                  "Two coordinates whose coupling is measured: hip_flexion_r,knee_angle_r. Repeatable.")
      ->type_name("NAME,NAME")
      ->allow_extra_args(false)
      ->group(what);
  command
      .add_flag(
          "--normalize", a.normalize,
          "Moments, power and work to body mass; angular momentum to mass, speed and height of the mass "
          "centre")
      ->group(what);
}

int run_motion_measures_command(const CommonOptions& common, const pipeline::AnalysisJob& analysis,
                                const pipeline::MeasuresJob& measures,
                                const MotionMeasuresArguments& arguments) {
  pipeline::MotionMeasuresJob job;
  static_cast<pipeline::MotionFiles&>(job) = analysis;
  static_cast<pipeline::MeasureChoice&>(job) = measures;
  job.select = measures.selection.select;
  job.couple = arguments.couple;
  job.normalize = arguments.normalize;
  if (!analysis.error_bars) job.refits = 0;
  static_cast<pipeline::GaitOutputs&>(job) = measures;
  return run_job(common, "motion", job, pipeline::run_motion_measures, print_motion_measures);
}

}  // namespace kinemark::cli
