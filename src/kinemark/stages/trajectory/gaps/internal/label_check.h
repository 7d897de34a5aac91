// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/stages/trajectory/gaps/internal/recording.h"

namespace kinemark::trajectory::internal {

/// Two markers whose labels are exchanged from frame `first` to before `end`.
struct Swap {
  Index first_marker = 0;
  Index second_marker = 0;
  Index first = 0;
  Index end = 0;
  double distance_m = 0.0;  ///< between them, median
};

/// True when the paths of two markers go on undisturbed across frame - 1 | frame only with their labels
/// exchanged. All four samples there are usable.
[[nodiscard]] bool paths_cross(const Recording& recording, Index a, Index b, Index frame);

/// Median distance of two markers over the frames of [first, end) where both are usable.
[[nodiscard]] double median_distance(const Recording& recording, Index a, Index b, Index first, Index end);

/// Swaps that begin and end while both markers are seen: two markers jump to each other's paths, and back
/// later, in a stretch that is complete and at most half of the recording. O(frames markers + leaps^2 per
/// frame).
[[nodiscard]] std::vector<Swap> find_crossings(const Recording& recording);

/// Compare the distances between markers that usually keep them with their usual values: find swaps, exchange
/// the samples back in the working copy, and mark what remains inconsistent as doubtful.
///
/// Swaps that begin and end while both markers are seen are found by their paths first. Cannot detect swaps
/// during gaps between markers with equal distances to all their neighbours, and single markers that are
/// wrong by
/// less than 10 mm and the usual spread. O(frames markers), and O(markers^2) once.
[[nodiscard]] std::vector<Swap> check_labels(Recording& recording);

}  // namespace kinemark::trajectory::internal
