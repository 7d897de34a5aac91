// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/around_options.h"

#include <fmt/core.h>

#include <string_view>

#include "cli/console.h"
#include "cli/dynamics_options.h"
#include "cli/heeded_options.h"
#include "cli/many_inputs.h"
#include "kinemark/core/number.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/measures/around_table.h"

namespace kinemark::cli {
namespace {

/// The two ends of --window.
Status take_window(const std::string& text, workflow::AroundChoice& choice) {
  if (text.empty()) return {};
  const auto comma = text.find(',');
  const auto wrong =
      fail(Code::usage,
           fmt::format("--window '{}': need FROM,TO in seconds after the event, such as -0.5,1", text));
  if (comma == std::string::npos) return wrong;
  const auto from = parse_number(std::string_view(text).substr(0, comma)),
             to = parse_number(std::string_view(text).substr(comma + 1));
  if (!from || !to) return wrong;
  choice.from_s = *from;
  choice.to_s = *to;
  return {};
}

}  // namespace

void add_around_options(CLI::App& command, AroundArguments& arguments) {
  auto& job = arguments.job;
  const char* group = "Around events";
  auto* around =
      command
          .add_option(
              "--around", job.what,
              "Averages around events instead of measures: units (spikes of each; unit:3 of one) of the "
              "movement; movement (starts of the markers' own), trials (trials:COLUMN by condition) or a "
              "label of events of the rate of each unit")
          ->type_name("WHAT")
          ->group(group);
  command.add_option("--window", arguments.window, "Seconds after the event, before it with a minus: -0.5,1")
      ->type_name("FROM,TO")
      ->default_str(fmt::format("{:g},{:g}", job.from_s, job.to_s))
      ->needs(around)
      ->group(group);
  command.add_option("--bin", job.bin_s, "Length of a bin")
      ->type_name("S")
      ->capture_default_str()
      ->needs(around)
      ->group(group);
  command
      .add_option("--spikes", job.spikes,
                  "File with units and trials on the same clock, .nwb; the recording itself when absent")
      ->type_name("FILE")
      ->needs(around)
      ->group(group);
  command
      .add_option("--clock-offset", job.clock_offset_s,
                  "Added to the times of spikes and trials: onto the recording's clock")
      ->type_name("S")
      ->capture_default_str()
      ->needs(around)
      ->group(group);
  command
      .add_option("--clock-sd", job.clock_sd_s, "One standard deviation of that, which intervals then hold")
      ->type_name("S")
      ->capture_default_str()
      ->needs(around)
      ->group(group);
}

int run_around_command(const CommonOptions& common, const CLI::App& command,
                       const MeasuresArguments& measures, AroundArguments& arguments) {
  if (measures.inputs.empty())
    return report_error(
        {.code = Code::usage, .message = "IN is required: a recording of markers, or a motion"});
  if (are_many(measures.inputs))
    return report_error({.code = Code::usage, .message = "--around takes one recording"});
  auto& job = arguments.job;
  job.input = measures.inputs.front();
  const auto kind = is_motion_file(job.input) ? AnalysisKind::around_motion : AnalysisKind::around;
  if (auto s = check_heeded(command, kind, job.input.filename().string()); !s) return report_error(s.error());
  if (auto s = take_window(arguments.window, job); !s) return report_error(s.error());
  static_cast<pipeline::RecordingOptions&>(job) = measures.job;
  job.output = measures.job.output;
  job.level = measures.job.level;
  job.refits = measures.job.refits;
  job.noise_sd_m = 1e-3 * measures.noise_mm;
  return run_job(common, "averages", job, pipeline::run_around,
                 [&job](const CommonOptions& options, const pipeline::AroundOutcome& outcome) {
                   for (const auto& warning : outcome.warnings) say(options, "note: " + warning);
                   if (options.json)
                     print_result(pipeline::json_text(pipeline::around_outcome_json(outcome, job)) + "\n");
                   else if (outcome.written.empty())
                     print_result(pipeline::around_text(outcome.curves, job));
                   say_written(options, outcome);
                 });
}

}  // namespace kinemark::cli
