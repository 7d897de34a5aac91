// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/groups/band_job.h"
#include "kinemark/pipeline/groups/norm_job.h"
#include "kinemark/pipeline/groups/retest_job.h"
#include "kinemark/pipeline/groups/spm_job.h"

namespace kinemark::cli {
namespace {

// What was found, as JSON or in words, and the files.
template <class Outcome, class Text, class Json>
auto print_with(const Text& text, const Json& json) {
  return [text, json](const CommonOptions& common, const Outcome& outcome) {
    for (const auto& warning : outcome.warnings) say(common, "note: " + warning);
    print_result(common.json ? pipeline::json_text(json(outcome)) + "\n" : text(outcome));
    say_written(common, outcome);
  };
}

template <class Job>
void add_tables(CLI::App& command, Job& job, const char* what) {
  command.add_option("IN", job.inputs, what)->required()->type_name("FILE");
  command
      .add_option("-o,--output", job.output,
                  "Table to write, .csv or .json; what was found is printed as well")
      ->group("Output");
}

void add_where(CLI::App& command, std::vector<std::string>& where, const char* name, const char* what) {
  command.add_option(name, where, what)->type_name("COLUMN=VALUE")->allow_extra_args(false)->group("Columns");
}

void add_columns(CLI::App& command, pipeline::CurveColumns& columns) {
  const char* group = "Columns";
  const auto column = [&](const char* name, std::string& value, const char* what) {
    command.add_option(name, value, what)->type_name("COLUMN")->group(group);
  };
  column("--group", columns.group, "Curves of one value here are a group; those of a file when absent");
  column("--subject", columns.subject,
         "Curves of one value here are averaged to one, and paired with those of it");
  command
      .add_option("--curve", columns.curve,
                  "What tells curves apart, with commas between; participant, session, file, trial, subject, "
                  "context, region, cycle and curve when absent")
      ->type_name("COLUMN")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(group);
  column("--at", columns.at, "Where on the curve; percent when absent");
  column("--value", columns.value, "The curve; value when absent");
  add_where(command, columns.where, "--where", "Only lines with this value there. Repeatable.");
}

constexpr const char* kCurves =
    "Tables of curves, .csv: one value a line with named columns, or numbers alone with a curve a line, a "
    "group a "
    "file";

void add_spm(CLI::App& groups, const CommonOptions& common, Run& run) {
  auto* command = groups.add_subcommand(
      "spm", "Where mean curves differ: one-dimensional statistical parametric mapping by permutation");
  command->footer(
      "One group is compared with 0, two with each other (--paired: curve by curve), more one way. The error "
      "over the\n"
      "whole curve is --alpha (Nichols & Holmes 2002; Pataky 2015). docs/stages/groups.md");
  const auto job = std::make_shared<pipeline::SpmJob>();
  add_tables(*command, *job, kCurves);
  add_columns(*command, job->columns);
  command
      ->add_flag("--paired", job->paired, "Curves of two groups belong together: by subject, or row by row")
      ->group("Test");
  command->add_option("--alpha", job->alpha, "Probability of any difference where there is none")
      ->type_name("SHARE")
      ->capture_default_str()
      ->group("Test");
  command->add_flag("--one-sided", job->one_sided, "Only where the first group is larger")->group("Test");
  command
      ->add_option("--arrangements", job->arrangements,
                   "Arrangements of the labels; all where there are no more")
      ->type_name("N")
      ->capture_default_str()
      ->group("Test");
  command->callback([&common, job, &run] {
    run = [&common, job] {
      return run_job(common, "groups", *job, pipeline::run_spm,
                     print_with<pipeline::SpmOutcome>(pipeline::spm_text, pipeline::spm_json));
    };
  });
}

void add_band(CLI::App& groups, const CommonOptions& common, Run& run) {
  auto* command = groups.add_subcommand("band", "Mean curves with bands that hold at all points at once");
  command->footer(
      "Two bands: of the mean curve, and of one further curve (a normative band, which `groups norm` "
      "reads).");
  const auto job = std::make_shared<pipeline::BandJob>();
  add_tables(*command, *job, kCurves);
  add_columns(*command, job->columns);
  command->add_option("--level", job->level, "Probability that a band holds at all points at once")
      ->type_name("SHARE")
      ->capture_default_str()
      ->group("Band");
  command->callback([&common, job, &run] {
    run = [&common, job] {
      return run_job(common, "groups", *job, pipeline::run_band,
                     print_with<pipeline::BandOutcome>(pipeline::band_text, pipeline::band_json));
    };
  });
}

void add_norm(CLI::App& groups, const CommonOptions& common, Run& run) {
  auto* command = groups.add_subcommand("norm", "Where curves leave a normative band from a file");
  const auto job = std::make_shared<pipeline::NormJob>();
  command
      ->add_option(
          "NORM", job->norm,
          "The band, .csv: percent with one_low and one_high as `groups band` writes them, low and high, or "
          "mean and sd")
      ->required()
      ->type_name("FILE");
  add_tables(*command, *job, kCurves);
  add_columns(*command, job->columns);
  add_where(*command, job->norm_where, "--norm-where",
            "Only lines of the band with this value there. Repeatable.");
  command->callback([&common, job, &run] {
    run = [&common, job] {
      return run_job(common, "groups", *job, pipeline::run_norm,
                     print_with<pipeline::NormOutcome>(pipeline::norm_text, pipeline::norm_json));
    };
  });
}

void add_retest(CLI::App& groups, const CommonOptions& common, Run& run) {
  auto* command = groups.add_subcommand(
      "retest",
      "Measures taken in several sessions: ICC, standard error of measurement, minimal detectable change");
  command->footer(
      "Values of a subject in a session are averaged. Where the table has the measures' own noise, it is "
      "taken out.\n"
      "ICC and intervals: Shrout & Fleiss 1979, McGraw & Wong 1996.");
  const auto job = std::make_shared<pipeline::RetestJob>();
  add_tables(*command, *job,
             "Tables of measures, .csv: one value a line with named columns, as `gait`, `measure` and `emg` "
             "write them");
  const auto column = [&](const char* name, std::string& value, const char* what) {
    command->add_option(name, value, what)->type_name("COLUMN")->capture_default_str()->group("Columns");
  };
  column("--subject", job->subject, "Who was measured");
  column("--session", job->session, "When");
  column("--value", job->value, "The measure");
  column("--sd", job->sd, "Its measurement noise, one standard deviation; may be absent");
  command
      ->add_option(
          "--by", job->by,
          "Each combination is tested by itself, with commas between; measure, subject, context and region "
          "when absent")
      ->type_name("COLUMN")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group("Columns");
  add_where(*command, job->where, "--where", "Only lines with this value there. Repeatable.");
  command->add_option("--level", job->level, "Coverage of the intervals")
      ->type_name("SHARE")
      ->capture_default_str()
      ->group("Test");
  command->callback([&common, job, &run] {
    run = [&common, job] {
      return run_job(common, "groups", *job, pipeline::run_retest,
                     print_with<pipeline::RetestOutcome>(pipeline::retest_text, pipeline::retest_json));
    };
  });
}

}  // namespace

void add_groups(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand(
      "groups", "Curves and measures of many trials and subjects: differences, bands, norms, retest");
  command->require_subcommand(1);
  add_spm(*command, common, run);
  add_band(*command, common, run);
  add_norm(*command, common, run);
  add_retest(*command, common, run);
}

}  // namespace kinemark::cli
