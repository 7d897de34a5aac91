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

/// The command that shows measures of a kind; nothing where they are of a motion.
std::optional<MeasuresOf> shown_by(MeasureKind kind) {
  switch (kind) {
    case MeasureKind::path:
      return MeasuresOf::paths;
    case MeasureKind::gait:
    case MeasureKind::plates:
      return MeasuresOf::walking;
    case MeasureKind::emg:
      return MeasuresOf::muscles;
    case MeasureKind::motion:
      return std::nullopt;
  }
  return std::nullopt;
}

std::vector<KnownMeasure> list_measures() {
  std::vector<KnownMeasure> out;
  for (const auto& one : analysis::path_definitions()) out.push_back({MeasureKind::path, one.what});
  for (const auto& one : analysis::rhythm_definitions()) out.push_back({MeasureKind::path, one});
  for (const auto& one : analysis::gait_definitions()) out.push_back({MeasureKind::gait, one.what});
  for (const auto& one : analysis::force_definitions()) out.push_back({MeasureKind::plates, one.what});
  for (const auto& one : analysis::emg_definitions()) out.push_back({MeasureKind::emg, one});
  for (const auto& one : analysis::body_definitions()) out.push_back({MeasureKind::motion, one.what});
  return out;
}

Status unknown_measure(const std::string& id) {
  std::vector<std::string> known{"gait", "plates", "emg"};
  for (const auto& one : known_measures())
    if (one.kind != MeasureKind::motion) known.emplace_back(one.what.id);
  const auto nearest = nearest_names(id, known);
  return fail(Code::usage, fmt::format("there is no measure '{}'{}; --list shows them all", id,
                                       nearest.empty() ? "" : fmt::format(" (nearest: {})", join(nearest))));
}

/// Each measure goes to the stage that takes it; a word for all of a kind stands for none of its own.
Status sort_measures(const MeasureOptions& options, AskedMeasures& out) {
  for (const auto& id : options.measures) {
    const auto kind = kind_of_measure(id);
    if (!kind) return unknown_measure(id);
    const auto shown = shown_by(*kind);
    if (!shown)
      return fail(
          Code::usage,
          fmt::format("{} is measured of a motion, not of markers; 'kinemark dynamics' measures it, of "
                      "a .mot or .sto with --model",
                      id));
    if (options.of != MeasuresOf::everything && options.of != *shown)
      return fail(Code::usage, fmt::format("{} is no measure of 'kinemark {}'; 'kinemark {}' measures it", id,
                                           command_of(options.of), command_of(*shown)));
    auto& stage = *kind == MeasureKind::path     ? out.path.measures
                  : *kind == MeasureKind::plates ? out.plates.measures
                  : *kind == MeasureKind::emg    ? out.emg.measures
                                                 : out.gait.measures;
    stage.push_back(id);
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

bool KnownMeasure::is_of(MeasuresOf of) const { return of == MeasuresOf::everything || shown_by(kind) == of; }

const std::vector<KnownMeasure>& known_measures() {
  static const auto all = list_measures();
  return all;
}

const KnownMeasure* find_measure(std::string_view id) {
  const auto& all = known_measures();
  const auto found = std::ranges::find(all, id, [](const KnownMeasure& one) { return one.what.id; });
  return found == all.end() ? nullptr : &*found;
}

std::optional<MeasureKind> kind_of_measure(std::string_view id) {
  if (id == "gait") return MeasureKind::gait;
  if (id == "plates") return MeasureKind::plates;
  if (id == "emg") return MeasureKind::emg;
  const auto* known = find_measure(id);
  return known == nullptr ? std::nullopt : std::optional(known->kind);
}

Result<AskedMeasures> asked_measures(const MeasureOptions& options) {
  AskedMeasures out{.options = options,
                    .path = {.curves = options.curves, .keep_outliers = options.keep_doubtful},
                    .gait = options.gait};
  spread_intervals(options, out);
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
  if (auto s = options.emg.envelope.check(); !s) return std::unexpected(s.error());
  if (auto s = out.path.check(); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace kinemark::workflow
