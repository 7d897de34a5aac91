// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Points of a recording that are no markers, under the names that a definition has for them.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/stages/analysis/segments/segment_definition.h"

namespace kinemark::workflow {

/// All names that formulas of a definition have for what is no entry of it: markers, and points of a model.
[[nodiscard]] std::set<std::string> names_of_points(const analysis::SegmentDefinition& definition);

/// Markers, and modelled points that stand in for markers.
struct MarkersAndModelled {
  data::Trajectories markers;       ///< the trial's, then modelled points as model_filled
  std::vector<std::string> points;  ///< names of those that were added
};

/// The trial's markers with those of its modelled points whose name is wanted and of which no marker has a
/// sample; nothing where there are none. A point at the origin is missing.
[[nodiscard]] std::optional<MarkersAndModelled> with_modelled_points(const data::Trial& trial,
                                                                     const std::set<std::string>& wanted);

/// Names in the file of wanted points that it has with a suffix: LFEO is LFE_MO, or LFEO_M.
[[nodiscard]] std::map<std::string, std::string> suffixed_names(const std::vector<std::string>& names,
                                                                const std::set<std::string>& wanted);

}  // namespace kinemark::workflow
