// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What edits made of a recording, marker by marker.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/data/trial.h"

namespace kinemark::trajectory {

/// How the samples of one marker differ between two states of a recording, on the frames that both have.
struct MarkerChange {
  std::string marker;                            ///< its name
  std::int64_t moved = 0;                        ///< samples that are there in both, elsewhere
  std::int64_t came = 0;                         ///< samples that were absent
  std::int64_t went = 0;                         ///< samples that are absent now
  std::int64_t restated = 0;                     ///< samples whose state alone is another
  double largest_m = 0.0;                        ///< longest way between the two places of a moved sample, m
  std::int64_t first_frame = 0, last_frame = 0;  ///< that differ, in the file's own numbers
};

/// Markers that differ, in the order of `after`, then those that are in `before` alone. Markers are the same
/// by name, frames by number. Places are compared to the bit. O(samples).
[[nodiscard]] std::vector<MarkerChange> changes_between(const data::Trial& before, const data::Trial& after);

/// The samples of `before` in the order of markers and frames of `after`, with positions and states; missing
/// where it has no such marker or frame.
[[nodiscard]] data::Trajectories aligned_to(const data::Trial& before, const data::Trial& after);

}  // namespace kinemark::trajectory
