// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/many_inputs.h"
#include "cli/recording_options.h"
#include "kinemark/pipeline/clean/clean_job.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::cli {
namespace {

/// With more markers than this the details are in the report only.
constexpr std::size_t kMarkersListed = 12;

struct CleanArguments {
  pipeline::CleanJob job;
  ManyArguments many;
  std::string gaps = "none", filter = "auto", upsampled = "mark", cutoff_rule = "winter";
  double noise_mm = 0.0, max_gap_sd_mm = 20.0;
  bool uncorrected = false, without_unfiltered = false;
};

void print_clean_outcome(const CommonOptions& common, const pipeline::CleanOutcome& outcome) {
  const auto& report = outcome.report;
  const auto& markers = outcome.trial.markers;
  std::int64_t open = 0, filled = 0, measured = 0;
  for (const auto state : markers.state) {
    measured += state == data::SampleState::measured;
    open += state == data::SampleState::missing || state == data::SampleState::rejected;
  }
  filled = static_cast<std::int64_t>(markers.state.size()) - open - measured;
  say(common, fmt::format("{} markers, {} frames at {:g} Hz; of {} samples {} measured, {} made, {} missing.",
                          markers.markers(), markers.frames(), markers.time.rate_hz, markers.state.size(),
                          measured, filled, open));
  if (report.account.markers.size() <= kMarkersListed)
    for (const auto& marker : report.account.markers)
      say(common, fmt::format("{}: {}", marker.name, marker.description));
  for (const auto& finding : report::clean_findings(report))
    say(common,
        fmt::format("{}: {}", finding.level == report::Verdict::good ? "note" : "attention", finding.text));
  for (const auto& note : outcome.warnings) say(common, fmt::format("note: {}", note));
  say_written(common, outcome);
  if (common.json) print_result(pipeline::json_text(report::clean_summary_json(report)) + "\n");
}

Status read_names(CleanArguments& arguments) {
  auto& job = arguments.job;
  const auto gaps = trajectory::parse_gap_method(arguments.gaps);
  if (!gaps) return std::unexpected(gaps.error());
  const auto filter = trajectory::parse_filter_method(arguments.filter);
  if (!filter) return std::unexpected(filter.error());
  const auto rule = trajectory::parse_cutoff_rule(arguments.cutoff_rule);
  if (!rule) return std::unexpected(rule.error());
  const auto made = workflow::parse_recorder_made(arguments.upsampled);
  if (!made) return std::unexpected(made.error());
  job.gaps.method = *gaps;
  job.filter.method = *filter;
  job.filter.cutoff_rule = *rule;
  job.recorder_made = *made;
  return {};
}

int run_command(const CommonOptions& common, CleanArguments& arguments) {
  if (auto s = read_names(arguments); !s) return report_error(s.error());
  auto& job = arguments.job;
  job.gaps.max_sd_m = 1e-3 * arguments.max_gap_sd_mm;
  job.gaps.noise_sd_m = job.filter.noise_sd_m = 1e-3 * arguments.noise_mm;
  job.filter.correct_cutoff = !arguments.uncorrected;
  job.keep_unfiltered = !arguments.without_unfiltered;
  auto& many = arguments.many;
  if (auto s = many.split_output(); !s) return report_error(s.error());
  if (!many.are_many()) {
    if (auto s = many.check_single(); !s) return report_error(s.error());
    job.input = many.inputs.front();
    job.output = many.output;
    return run_job(common, "markers", job, pipeline::run_clean, print_clean_outcome);
  }
  many.pages = job.report;
  if (auto s = pipeline::check_for_several(job); !s) return report_error(s.error());
  const auto clean_one = [&job](const std::filesystem::path& input, const std::filesystem::path& output,
                                const std::filesystem::path& page,
                                const pipeline::JobSettings& settings) -> Result<pipeline::JobOutcome> {
    pipeline::CleanJob one = job;
    static_cast<pipeline::JobSettings&>(one) = settings;
    one.input = input;
    drop_what_it_states(one, input);
    one.output = output;
    one.report = page;
    return pipeline::run_clean(one);
  };
  return run_each(common, many, many.to, "_report.json", clean_one);
}

}  // namespace

void add_clean(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand("clean", "Gaps filled, noise smoothed, derivatives, provenance kept");
  command->footer(
      "Reads and writes .c3d, .trc, .csv, .nwb. Nothing is filled unless --gaps says how; every sample "
      "keeps\n"
      "its state (measured, interpolated, model_filled, upsampled, rejected, missing) and its SD.");
  const auto arguments = std::make_shared<CleanArguments>();
  auto& job = arguments->job;
  auto& many = arguments->many;
  add_in_and_out(*command, many, "Recording to read; several, or a folder of them");
  add_many_options(*command, many);
  command
      ->add_option("--gaps", arguments->gaps,
                   "none, auto, linear, cubic, pchip, walk, rigid, regression or pca")
      ->capture_default_str();
  command->add_option("--max-gap", job.gaps.max_gap_s, "Longer gaps stay open, s")->capture_default_str();
  command
      ->add_option("--max-gap-sd", arguments->max_gap_sd_mm,
                   "Largest standard deviation of a fill, mm; other gaps stay open")
      ->capture_default_str();
  command
      ->add_option("--filter", arguments->filter,
                   "auto (kalman), none, kalman, butterworth, gcv, savgol or classic")
      ->capture_default_str();
  command
      ->add_option("--order", job.filter.order,
                   "Order of the filter; 0: found from the data, or the usual one")
      ->capture_default_str();
  command->add_option("--cutoff", job.filter.cutoff_hz, "-3 dB of the whole filter, Hz; 0: found from data")
      ->capture_default_str();
  command
      ->add_option("--cutoff-rule", arguments->cutoff_rule, "butterworth without --cutoff: winter, challis")
      ->capture_default_str();
  command->add_flag("--uncorrected-cutoff", arguments->uncorrected,
                    "butterworth: cut-off of each pass, as filtfilt of other programs");
  command->add_option("--noise", arguments->noise_mm, "Marker noise per axis, mm; 0: found from the data")
      ->capture_default_str();
  command
      ->add_option("--upsampled", arguments->upsampled,
                   "Samples that the recorder interpolated: keep, mark, missing or decimate")
      ->capture_default_str();
  command->add_flag("--without-unfiltered", arguments->without_unfiltered,
                    "Do not keep the samples from before the filter beside the smoothed ones");
  command->add_flag("!--keep-exchanges", job.exchange_back,
                    "Leave markers that carry each other's label as they are; reported all the same");
  command->add_flag("--derivatives", job.derivatives,
                    "Write velocity, acceleration and jerk with their SDs too");
  add_recording_options(*command, job, pipeline::Doubtful::keep);
  command->add_option("--report", job.report, "Page to write, .html; a folder for several recordings");
  command->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return run_command(common, *arguments); }; });
}

}  // namespace kinemark::cli
