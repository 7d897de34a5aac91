// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <utility>

#include "kinemark/core/version.h"
#include "kinemark/pipeline/clean/internal/clean_account.h"

namespace kinemark::pipeline::internal {
namespace {

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
                 {"exchanged labels", job.exchange_back ? "exchanged back" : "told"},
                 {"defects", job.drops_doubtful(false) ? "rejected" : "told"},
                 {"derivatives", job.derivatives ? "written" : "not written"}};
  if (filter.method == trajectory::FilterMethod::butterworth) {
    run.options.emplace_back("cut-off rule", trajectory::to_string(filter.cutoff_rule));
    run.options.emplace_back("cut-off of both passes together", filter.correct_cutoff ? "yes" : "no");
  }
  return run;
}

}  // namespace kinemark::pipeline::internal
