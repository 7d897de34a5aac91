// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/segments/internal/segment_notes.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinemark::workflow {

void note_static_angles(const analysis::SegmentMotion& motion, std::vector<std::string>& warnings) {
  constexpr double kSeen_rad = 0.1 * std::numbers::pi / 180.0;
  std::vector<std::string> turns;
  for (const auto& p : motion.parameters)
    if (p.name.ends_with("TibialTorsion") && std::abs(p.value) > kSeen_rad)
      turns.push_back(fmt::format("{} {:.1f} deg", p.name, p.value * 180.0 / std::numbers::pi));
  if (!turns.empty())
    warnings.push_back(
        fmt::format("Knee rotation of a static trial contains the tibia's torsion, that of a walk does not: "
                    "beside a walk "
                    "it jumps by {}.",
                    fmt::join(turns, ", ")));
}

void note_choices(const analysis::SegmentDefinition& definition, const analysis::SegmentMotion& motion,
                  std::vector<std::string>& warnings) {
  for (const auto& used : motion.parameters) {
    const auto p =
        std::ranges::find(definition.parameters, used.name, &analysis::SegmentDefinition::Parameter::name);
    if (!used.assumed || p == definition.parameters.end() || p->choices.empty()) continue;
    warnings.push_back(fmt::format(
        "{} is assumed to be {:g}: no file tells; --subject {}={:g} is the other.", used.name, used.value,
        used.name, p->choices.front() == used.value ? p->choices.back() : p->choices.front()));
  }
}

void find_cross_talk(const analysis::SegmentDefinition& definition, SegmentsFound& found) {
  for (const auto& series : found.motion.angles) {
    const auto a =
        std::ranges::find(definition.angles, series.name, &analysis::SegmentDefinition::Angle::name);
    if (a == definition.angles.end() || !a->cross_talk) continue;
    const auto talk = analysis::find_cross_talk(series);
    if (!talk) continue;
    found.cross_talk.emplace_back(series.name, *talk);
    if (talk->suspicious()) found.remarks.warnings.push_back(talk->sentence(series.name));
  }
}

}  // namespace kinemark::workflow
