// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/stages/trajectory/gaps/internal/recording.h"

namespace kinemark::trajectory::internal {

/// Two markers that sit in each other's place from frame `first` to before `end`.
struct Swap {
  Index first_marker = 0;
  Index second_marker = 0;
  Index first = 0;
  Index end = 0;
  double distance_m = 0.0;  ///< between them, median
};

/// Compare the distances between markers that usually keep them with their usual values: find swaps, exchange
/// the samples back in the working copy, and set what remains out of place as doubtful.
///
/// Does not see swaps of markers that are alike to all their neighbours, and single markers that are wrong by
/// less than 10 mm and the usual spread. O(frames markers), and O(markers^2) once.
[[nodiscard]] std::vector<Swap> check_labels(Recording& recording);

}  // namespace kinemark::trajectory::internal
