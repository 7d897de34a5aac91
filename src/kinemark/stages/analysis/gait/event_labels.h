// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Stored events of feet that contradict what the markers say.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinemark/data/gait_event.h"
#include "kinemark/stages/analysis/gait/marker_events.h"

namespace kinemark::analysis {

/// Sentences on events of the file that lie more than 150 ms and 4 SD from those of the markers: sides
/// exchanged, strikes and offs exchanged, or another clock where that explains three quarters of them (three
/// at least) and they do not fit as they are; else each event that lies so by itself, with its distance.
/// Nothing where markers tell no gait, and of events beyond the markers' own or near none of them: a hidden
/// foot contradicts nobody.
[[nodiscard]] std::vector<std::string> contradicted_labels(const MarkerEvents& of_markers,
                                                           std::span<const data::GaitEvent> of_file);

}  // namespace kinemark::analysis
