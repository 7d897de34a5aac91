// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What cannot be computed, and for want of what.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinemark/stages/analysis/segments/segment_graph.h"

namespace kinemark::analysis::internal {

/// One sentence for outputs of a graph that lack the same, or something in common, without those whose name
/// is empty.
/// @param names    of the outputs, as sentences call them
/// @param markers  of the recording, the nearest of which is shown
[[nodiscard]] std::vector<std::string> lack_sentences(const SegmentDefinition& definition,
                                                      std::span<const std::string> names,
                                                      const SegmentGraph& graph,
                                                      const std::vector<std::string>& markers);

}  // namespace kinemark::analysis::internal
