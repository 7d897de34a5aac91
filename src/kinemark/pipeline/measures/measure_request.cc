// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measure_request.h"

#include <fmt/core.h>

#include <utility>

namespace kinemark::pipeline {
namespace {

/// What is asked of walking and of cycles fits what the command is about.
Status check_walking(const MeasuresJob& job) {
  if (job.gait.of_movement() && job.of != workflow::MeasuresOf::everything &&
      job.of != workflow::MeasuresOf::paths)
    return fail(
        Code::usage,
        fmt::format("--events movement is none of 'kinemark {}'; 'kinemark measure' takes the markers' own",
                    workflow::command_of(job.of)));
  if (job.of == workflow::MeasuresOf::muscles && job.gait.wanted() && job.emg.write_cycles.empty())
    return fail(Code::usage, fmt::format("--{} is of walking, over whose cycles nothing is written; need "
                                         "--write-cycles FILE.csv too",
                                         job.gait.events == "best" ? "gait-marker" : "events"));
  return {};
}

}  // namespace

Result<workflow::MeasureOptions> measure_options(const MeasuresJob& job) {
  const bool drawn = !job.figures.empty() || !job.report.empty();
  auto gait = gait_options(job.gait, drawn);
  if (!gait) return std::unexpected(gait.error());
  if (auto s = job.emg.check(); !s) return std::unexpected(s.error());
  if (auto s = check_walking(job); !s) return std::unexpected(s.error());
  workflow::MeasureOptions out;
  static_cast<workflow::MeasureChoice&>(out) = job;
  out.of = job.of;
  out.gait = std::move(*gait);
  out.noise_sd_m = job.noise_sd_m;
  out.seed = job.seed;
  out.threads = job.threads;
  out.keep_doubtful = !job.drops_doubtful(true);
  out.curves = drawn;
  const bool cycles_of_emg = !job.emg.write_cycles.empty();
  out.needs = {.events = job.gait.writes(),
               .own_movements = job.gait.of_movement(),
               .walking = job.gait.wanted(),
               .strides = cycles_of_emg,
               .emg = job.emg.wanted(),
               .envelopes = cycles_of_emg || !job.emg.write.empty()};
  if (auto asked = workflow::asked_measures(out); !asked) return std::unexpected(asked.error());
  auto emg = emg_choice(job.emg);
  if (!emg) return std::unexpected(emg.error());
  out.emg = std::move(*emg);
  return out;
}

}  // namespace kinemark::pipeline
