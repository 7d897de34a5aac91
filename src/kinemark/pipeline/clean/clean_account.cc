// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>

#include "kinemark/core/version.h"
#include "kinemark/pipeline/clean/internal/clean_account.h"

namespace kinemark::pipeline::internal {
namespace {

std::string name_of(const std::vector<std::string>& names, std::int64_t marker) {
  return marker < 0 ? std::string() : names[static_cast<std::size_t>(marker)];
}

std::string or_found(double value, const char* unit) {
  return value > 0.0 ? fmt::format("{:g} {}", value, unit) : "found from the data";
}

}  // namespace

report::CleanRun describe_run(const CleanJob& job, const data::Trial& trial) {
  report::CleanRun run;
  run.trial = job.input.filename().string();
  run.gap_method = trajectory::to_string(job.gaps.method);
  run.filter_method = trajectory::to_string(job.filter.method);
  run.version = kVersion;
  run.command_line = job.command_line;
  run.seed = job.seed;
  run.threads = job.threads;
  run.warnings = trial.warnings;
  const auto& filter = job.filter;
  run.options = {{"gaps", run.gap_method},
                 {"longest gap filled", fmt::format("{:g} s", job.gaps.max_gap_s)},
                 {"largest SD filled", fmt::format("{:g} mm", 1e3 * job.gaps.max_sd_m)},
                 {"filter", run.filter_method},
                 {"order", filter.order > 0 ? std::to_string(filter.order) : "found from the data"},
                 {"cut-off", or_found(filter.cutoff_hz, "Hz")},
                 {"marker noise", or_found(1e3 * filter.noise_sd_m, "mm")},
                 {"samples that the recorder made", std::string(to_string(job.recorder_made))},
                 {"defects", job.reject_defects ? "rejected" : "told"},
                 {"derivatives", job.derivatives ? "written" : "not written"}};
  if (filter.method == trajectory::FilterMethod::butterworth) {
    run.options.emplace_back("cut-off rule", trajectory::to_string(filter.cutoff_rule));
    run.options.emplace_back("cut-off of both passes together", filter.correct_cutoff ? "yes" : "no");
  }
  return run;
}

report::CleanUpsampling describe_upsampling(const trajectory::UpsamplingReport& found, RecorderMade made) {
  report::CleanUpsampling told;
  told.looked = true;
  told.factor = found.recording.factor;
  told.sentences = found.sentences;
  for (const auto& marker : found.markers) told.factor = std::max(told.factor, marker.factor);
  if (told.factor == 1) return told;
  const char* words[] = {"left as they are", "marked as upsampled", "removed",
                         "removed, and the rate brought down"};
  told.done = words[static_cast<int>(made)];
  told.handled = made != RecorderMade::keep;
  return told;
}

void add_defects(report::CleanReport& report, std::span<const trajectory::Finding> findings, bool rejected,
                 const std::vector<std::string>& names) {
  for (const auto& finding : findings) {
    const bool gone = rejected && finding.confidence >= kRejectConfidence &&
                      finding.defect != trajectory::Defect::clock_jump;
    report.defects.push_back({.kind = std::string(trajectory::to_string(finding.defect)),
                              .marker = name_of(names, finding.marker),
                              .other_marker = name_of(names, finding.other_marker),
                              .first_frame = finding.first_frame,
                              .last_frame = finding.last_frame,
                              .confidence = finding.confidence,
                              .sentence = finding.sentence,
                              .done = gone ? "rejected" : "left as it is",
                              .handled = gone});
  }
}

void add_gaps(report::CleanReport& report, const trajectory::GapResult& filled,
              const std::vector<std::string>& names) {
  for (const auto& gap : filled.gaps) {
    report::CleanGap told{.marker = name_of(names, gap.marker),
                          .first_frame = gap.first_frame,
                          .last_frame = gap.last_frame,
                          .at_edge = gap.at_edge,
                          .filled = gap.filled,
                          .method = gap.method,
                          .weights = {},
                          .sd_m = gap.sd_m,
                          .max_sd_m = gap.max_sd_m,
                          .windows = gap.windows,
                          .window_s = gap.window_s,
                          .predictors = gap.predictors,
                          .dropped = gap.dropped,
                          .why_open = gap.why_open};
    for (const auto& c : gap.candidates)
      told.weights.push_back({.name = c.name, .weight = c.weight, .rms_m = c.rms_m, .guarded = c.guarded});
    report.gaps.push_back(std::move(told));
  }
  for (const auto& swap : filled.swaps)
    report.defects.push_back({.kind = "label swap",
                              .marker = name_of(names, swap.first_marker),
                              .other_marker = name_of(names, swap.second_marker),
                              .first_frame = swap.first_frame,
                              .last_frame = swap.last_frame,
                              .confidence = kNaN,
                              .sentence = swap.sentence,
                              .done = "not relied on when filling; left as it is",
                              .handled = false});
}

report::CleanMarker describe_marker(const trajectory::MarkerAccount& account,
                                    const trajectory::UpsamplingReport& found, std::int64_t marker) {
  const auto m = static_cast<std::size_t>(marker);
  report::CleanMarker told;
  told.name = account.name;
  told.filter = account.used;
  told.words = account.words;
  told.noise_from = account.noise_from;
  told.criterion_name = account.criterion_name;
  for (const auto& c : account.candidates)
    told.tried.push_back({.order = c.order, .cutoff_hz = c.cutoff_hz, .criterion = c.criterion});
  told.residual_rms_m = account.residual_rms_m;
  told.autocorrelation = account.autocorrelation;
  told.ljung_box_p = account.autocorrelation.empty() ? kNaN : account.ljung_box_p;
  told.white = account.white;
  std::ranges::copy(account.bar_scale, told.bar_scale.begin());
  std::ranges::copy(account.gap_bar_scale, told.gap_bar_scale.begin());
  told.bad_variances = account.bad_variances;
  told.upsampling_factor = found.markers[m].factor;
  if (told.upsampling_factor > 1) told.upsampling_kernel = trajectory::to_string(found.markers[m].kernel);
  told.band = trajectory::to_string(found.marker_bands[m].verdict);
  told.spectrum = {.frequency_hz = account.spectrum.frequency_hz,
                   .raw_m2_per_hz = account.spectrum.raw_m2_per_hz,
                   .residual_m2_per_hz = account.spectrum.residual_m2_per_hz};
  return told;
}

}  // namespace kinemark::pipeline::internal
