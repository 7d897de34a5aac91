// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What of a walk's names, plates and labels contradicts what its markers show.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/gait/marker_events.h"

namespace kinemark::analysis {

/// One sentence each.
struct Contradictions {
  std::vector<std::string> names;   ///< of markers and sides, where the markers show a gait
  std::vector<std::string> plates;  ///< of force plates, likewise
  std::vector<std::string> labels;  ///< of single events of the file, or of all of them
};

/// @param labels  events of the file, ascending
[[nodiscard]] Contradictions find_contradictions(const GaitSmoother& smoother, const MarkerEvents& of_markers,
                                                 const GaitEvidence& evidence,
                                                 std::span<const data::GaitEvent> labels, NamesOf names);

}  // namespace kinemark::analysis
