// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/stages/analysis/gait/event_labels.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/gait/marker_events.h"
#include "kinemark/stages/analysis/gait/plate_facts.h"

namespace kinemark::analysis {

std::vector<std::string> contradictions_of(const data::Trajectories& markers, const GaitEvidence& evidence) {
  auto of_file = events_of_file(evidence.events, markers.time);
  std::vector<std::string> out = std::move(of_file.notes);
  const auto which = find_gait_markers(markers, {});
  if (!which) return out;
  auto smoother = GaitSmoother::create(markers, *which, 0.0, std::nullopt);
  if (!smoother) return out;
  const auto of_markers = find_marker_events(*smoother, *which);
  if (!of_markers) return out;
  const bool goes = of_markers->kind.not_gait.empty();
  if (goes)
    std::ranges::move(name_findings_of(*smoother, *of_markers, NamesOf::ends_and_sides),
                      std::back_inserter(out));
  std::ranges::move(contradicted_labels(*of_markers, of_file.events), std::back_inserter(out));
  if (evidence.plates != nullptr && goes)
    std::ranges::move(contradicted_plates(*evidence.plates, smoother->in_laboratory(), smoother->upright(),
                                          of_markers->kind.stride_s, evidence.mass_kg),
                      std::back_inserter(out));
  return out;
}

}  // namespace kinemark::analysis
