// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/measures/asked.h"

#include <fmt/core.h>

#include <algorithm>

#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"
#include "kinemark/stages/analysis/body/body_definitions.h"
#include "kinemark/stages/analysis/gait/spatiotemporal.h"
#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/path_rhythm.h"

namespace kinemark::workflow {
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

/// Each measure goes to the stage that takes it; a word for all of a kind stands for none of its own.
Status sort_measures(const MeasureOptions& options, AskedMeasures& out) {
  for (const auto& id : options.measures) {
    const auto kind = measures_of(id);
    if (!kind) return unknown_measure(id);
    if (options.of != MeasuresOf::everything && options.of != *kind)
      return fail(Code::usage, fmt::format("{} is no measure of 'kinemark {}'; 'kinemark {}' measures it", id,
                                           command_of(options.of), command_of(*kind)));
    if (*kind == MeasuresOf::paths)
      out.path.measures.push_back(id);
    else if (*kind == MeasuresOf::muscles)
      out.emg.measures.push_back(id);
    else if (id == "plates" || analysis::find_force_definition(id) != nullptr)
      out.plates.measures.push_back(id);
    else
      out.gait.measures.push_back(id);
  }
  out.by_name = !out.gait.measures.empty();
  out.forces_by_name = !out.plates.measures.empty();
  out.muscles_by_name = !out.emg.measures.empty();
  const auto leave_to_stage = [](const char* all, std::vector<std::string>& ids) {
    if (std::ranges::find(ids, all) != ids.end()) ids.clear();
  };
  leave_to_stage("gait", out.gait.measures);
  leave_to_stage("plates", out.plates.measures);
  leave_to_stage("emg", out.emg.measures);
  return {};
}

void spread_intervals(const MeasureOptions& options, AskedMeasures& out) {
  const auto put = [&options](auto& stage) {
    stage.refits = options.refits;
    stage.level = options.level;
    stage.seed = options.seed;
  };
  put(out.path), put(out.gait), put(out.plates), put(out.emg);
  out.path.noise_sd_m = out.gait.noise_sd_m = options.noise_sd_m;
  out.path.threads = out.gait.threads = out.emg.threads = options.threads;
}

}  // namespace

const char* command_of(MeasuresOf of) {
  return of == MeasuresOf::walking ? "gait" : of == MeasuresOf::muscles ? "emg" : "measure";
}

std::optional<MeasuresOf> measures_of(const std::string& id) {
  if (id == "emg" || analysis::find_emg_definition(id) != nullptr) return MeasuresOf::muscles;
  if (id == "gait" || id == "plates" || analysis::find_force_definition(id) != nullptr ||
      analysis::find_gait_definition(id) != nullptr)
    return MeasuresOf::walking;
  if (is_path_measure(id)) return MeasuresOf::paths;
  return std::nullopt;
}

Result<AskedMeasures> asked_measures(const MeasureOptions& options) {
  if (auto s = options.emg.envelope.check(); !s) return std::unexpected(s.error());
  AskedMeasures out{.options = options,
                    .path = {.curves = options.curves, .keep_outliers = options.keep_doubtful},
                    .gait = options.gait};
  if (auto s = sort_measures(options, out); !s) return std::unexpected(s.error());
  const auto& needs = options.needs;
  const auto by_itself = [&options](MeasuresOf kind) {
    return options.measures.empty() && (options.of == MeasuresOf::everything || options.of == kind);
  };
  out.by_name = out.by_name || needs.walking || needs.strides;
  out.paths = by_itself(MeasuresOf::paths) || !out.path.measures.empty();
  out.walking = (out.by_name || by_itself(MeasuresOf::walking) || needs.events) && !needs.own_movements &&
                options.of != MeasuresOf::paths;
  out.forces = out.forces_by_name || by_itself(MeasuresOf::walking);
  out.muscles_by_name =
      out.muscles_by_name || needs.emg || (options.of == MeasuresOf::muscles && options.measures.empty());
  out.muscles = out.muscles_by_name || by_itself(MeasuresOf::muscles);
  spread_intervals(options, out);
  if (auto s = out.path.check(); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace kinemark::workflow
