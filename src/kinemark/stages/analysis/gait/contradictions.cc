// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/contradictions.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/stages/analysis/gait/event_labels.h"
#include "kinemark/stages/analysis/gait/plate_facts.h"

namespace kinemark::analysis {

Contradictions find_contradictions(const GaitSmoother& smoother, const MarkerEvents& of_markers,
                                   const GaitEvidence& evidence, std::span<const data::GaitEvent> labels,
                                   NamesOf names) {
  Contradictions out{.labels = contradicted_labels(of_markers, labels)};
  if (!of_markers.kind.not_gait.empty()) return out;
  out.names = name_findings_of(smoother, of_markers, names);
  if (evidence.plates != nullptr)
    out.plates = contradicted_plates(*evidence.plates, smoother.in_laboratory(), smoother.upright(),
                                     of_markers.kind.stride_s, evidence.mass_kg);
  return out;
}

Contradictions contradictions_of(const data::Trajectories& markers, const GaitEvidence& evidence) {
  auto of_file = events_of_file(evidence.events, markers.time);
  Contradictions out{.labels = std::move(of_file.notes)};
  const auto which = find_gait_markers(markers, {});
  if (!which) return out;
  auto smoother = GaitSmoother::create(markers, *which, 0.0, std::nullopt);
  if (!smoother) return out;
  const auto of_markers = find_marker_events(*smoother, *which);
  if (!of_markers) return out;
  auto found = find_contradictions(*smoother, *of_markers, evidence, of_file.events, NamesOf::ends_and_sides);
  std::ranges::move(out.labels, std::back_inserter(found.labels));  // what explains all of them goes first
  return found;
}

}  // namespace kinemark::analysis
