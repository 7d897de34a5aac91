// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measure_request.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"
#include "kinemark/stages/analysis/body/body_definitions.h"
#include "kinemark/stages/analysis/gait/spatiotemporal.h"
#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/path_rhythm.h"

namespace kinemark::pipeline {
namespace {

Status unknown_measure(const std::string& id) {
  if (analysis::find_body_definition(id) != nullptr)
    return fail(Code::usage,
                fmt::format("{} is measured of a motion, not of markers; 'kinemark dynamics' measures it, of "
                            "a .mot or .sto with --model",
                            id));
  std::vector<std::string> known{"gait", "plates", "emg"};
  for (const auto& definition : analysis::path_definitions()) known.emplace_back(definition.what.id);
  for (const auto& definition : analysis::rhythm_definitions()) known.emplace_back(definition.id);
  for (const auto& definition : analysis::gait_definitions()) known.emplace_back(definition.what.id);
  for (const auto& definition : analysis::force_definitions()) known.emplace_back(definition.what.id);
  for (const auto& definition : analysis::emg_definitions()) known.emplace_back(definition.id);
  const auto nearest = nearest_names(id, known);
  return fail(Code::usage, fmt::format("there is no measure '{}'{}; --list shows them all", id,
                                       nearest.empty() ? "" : fmt::format(" (nearest: {})", join(nearest))));
}

/// The command for measures of this kind.
const char* command_of(workflow::MeasuresOf of) {
  return of == workflow::MeasuresOf::walking   ? "gait"
         : of == workflow::MeasuresOf::muscles ? "emg"
                                               : "measure";
}

Status check_kinds(const MeasuresJob& job) {
  for (const auto& id : job.measures) {
    const auto kind = workflow::measures_of(id);
    if (!kind) return unknown_measure(id);
    if (job.of != workflow::MeasuresOf::everything && job.of != *kind)
      return fail(Code::usage, fmt::format("{} is no measure of 'kinemark {}'; 'kinemark {}' measures it", id,
                                           command_of(job.of), command_of(*kind)));
  }
  return {};
}

/// What is asked of walking and of cycles fits what the command is about.
Status check_walking(const MeasuresJob& job) {
  if (job.gait.of_movement() && job.of != workflow::MeasuresOf::everything &&
      job.of != workflow::MeasuresOf::paths)
    return fail(
        Code::usage,
        fmt::format("--events movement is none of 'kinemark {}'; 'kinemark measure' takes the markers' own",
                    command_of(job.of)));
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
  if (auto s = check_kinds(job); !s) return std::unexpected(s.error());
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
