// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measures_asked.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
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

bool is_path_measure(const std::string& id) {
  return std::ranges::any_of(analysis::path_definitions(), [&](const auto& d) { return d.what.id == id; }) ||
         analysis::find_rhythm_definition(id) != nullptr;
}

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
const char* command_of(MeasuresOf of) {
  return of == MeasuresOf::walking ? "gait" : of == MeasuresOf::muscles ? "emg" : "measure";
}

Status check_kinds(const MeasuresJob& job) {
  for (const auto& id : job.measures) {
    const auto kind = measures_of(id);
    if (!kind) return unknown_measure(id);
    if (job.of != MeasuresOf::everything && job.of != *kind)
      return fail(Code::usage, fmt::format("{} is no measure of 'kinemark {}'; 'kinemark {}' measures it", id,
                                           command_of(job.of), command_of(*kind)));
  }
  return {};
}

}  // namespace

std::optional<MeasuresOf> measures_of(const std::string& id) {
  if (id == "emg" || analysis::find_emg_definition(id) != nullptr) return MeasuresOf::muscles;
  if (id == "gait" || id == "plates" || analysis::find_force_definition(id) != nullptr ||
      analysis::find_gait_definition(id) != nullptr)
    return MeasuresOf::walking;
  if (is_path_measure(id)) return MeasuresOf::paths;
  return std::nullopt;
}

Result<AskedMeasures> asked_measures(const MeasuresJob& job) {
  const bool drawn = !job.figures.empty() || !job.report.empty();
  auto gait = gait_options(job.gait, drawn);
  if (!gait) return std::unexpected(gait.error());
  AskedMeasures out{.path = {.refits = job.refits,
                             .noise_sd_m = job.noise_sd_m,
                             .level = job.level,
                             .seed = job.seed,
                             .threads = job.threads,
                             .curves = drawn,
                             .keep_outliers = !job.drops_doubtful(true)},
                    .gait = std::move(*gait)};
  if (auto s = job.emg.check(); !s) return std::unexpected(s.error());
  if (auto s = check_kinds(job); !s) return std::unexpected(s.error());
  if (job.gait.of_movement() && job.of != MeasuresOf::everything && job.of != MeasuresOf::paths)
    return fail(
        Code::usage,
        fmt::format("--events movement is none of 'kinemark {}'; 'kinemark measure' takes the markers' own",
                    command_of(job.of)));
  if (job.of == MeasuresOf::muscles && job.gait.wanted() && job.emg.write_cycles.empty())
    return fail(Code::usage, fmt::format("--{} is of walking, over whose cycles nothing is written; need "
                                         "--write-cycles FILE.csv too",
                                         job.gait.events == "best" ? "gait-marker" : "events"));
  const auto by_itself = [&job](MeasuresOf kind) {
    return job.measures.empty() && (job.of == MeasuresOf::everything || job.of == kind);
  };
  bool all_of_walking = false, all_of_plates = false, all_of_emg = false;
  for (const auto& id : job.measures) {
    if (id == "gait")
      all_of_walking = true;
    else if (id == "plates")
      all_of_plates = true;
    else if (id == "emg")
      all_of_emg = true;
    else if (analysis::find_force_definition(id) != nullptr)
      out.plates.measures.push_back(id);
    else if (analysis::find_emg_definition(id) != nullptr)
      out.emg.measures.push_back(id);
    else if (analysis::find_gait_definition(id) != nullptr)
      out.gait.measures.push_back(id);
    else
      out.path.measures.push_back(id);
  }
  const bool only_paths = job.of == MeasuresOf::paths;
  out.by_name =
      all_of_walking || !out.gait.measures.empty() || job.gait.wanted() || !job.emg.write_cycles.empty();
  out.paths = by_itself(MeasuresOf::paths) || !out.path.measures.empty();
  out.walking = (out.by_name || by_itself(MeasuresOf::walking) || job.gait.writes()) &&
                !job.gait.of_movement() && !only_paths;
  if (all_of_walking) out.gait.measures.clear();
  out.forces_by_name = all_of_plates || !out.plates.measures.empty();
  out.forces = out.forces_by_name || by_itself(MeasuresOf::walking);
  if (all_of_plates) out.plates.measures.clear();
  out.muscles_by_name = all_of_emg || !out.emg.measures.empty() || job.emg.wanted() ||
                        (job.of == MeasuresOf::muscles && job.measures.empty());
  out.muscles = out.muscles_by_name || by_itself(MeasuresOf::muscles);
  if (all_of_emg) out.emg.measures.clear();
  out.plates.refits = out.emg.refits = job.refits;
  out.plates.level = out.emg.level = job.level;
  out.plates.seed = out.emg.seed = job.seed;
  out.emg.threads = job.threads;
  out.gait.refits = job.refits;
  out.gait.noise_sd_m = job.noise_sd_m;
  out.gait.level = job.level;
  out.gait.seed = job.seed;
  out.gait.threads = job.threads;
  if (auto s = out.path.check(); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace kinemark::pipeline
