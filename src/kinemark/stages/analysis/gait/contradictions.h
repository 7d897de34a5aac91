// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What of a walk's names, plates and labels contradicts what its markers show.
#pragma once

#include <span>

#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/gait/marker_events.h"

namespace kinemark::analysis {

/// @param labels  events of the file, ascending
[[nodiscard]] Contradictions find_contradictions(const GaitSmoother& smoother, const MarkerEvents& of_markers,
                                                 const GaitEvidence& evidence,
                                                 std::span<const data::GaitEvent> labels, NamesOf names);

}  // namespace kinemark::analysis
