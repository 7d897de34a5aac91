// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The recordings that segments are computed from, as formulas see them.
#pragma once

#include <list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/workflow/segments/internal/modelled_points.h"
#include "kinemark/workflow/segments/segments.h"

namespace kinemark::workflow {

/// Trials beside the recording, screened, and markers of all with modelled points where some stand in for
/// markers.
struct SegmentTrials {
  std::optional<data::Trial> still;          ///< none: there is none, or it is the recording
  std::map<std::string, data::Trial> shown;  ///< by the names that the definition has for them
  std::list<MarkersAndModelled> modelled;    ///< stays where it is: the input points into it
};

/// Markers of all trials, and names of outputs in them. A sentence for each trial with modelled points that
/// stand in for markers.
/// @param own_static  the recording is its own static trial
/// @return            points into `recording` and `trials`, which must outlive it
[[nodiscard]] analysis::SegmentInput points_of(const analysis::SegmentDefinition& definition,
                                               const SegmentsOptions& options, bool own_static,
                                               const data::Trial& recording, SegmentTrials& trials,
                                               std::vector<std::string>& warnings);

}  // namespace kinemark::workflow
