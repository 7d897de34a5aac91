// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/stages/trajectory/gaps/internal/crossings.h"

namespace kinemark::trajectory::internal {

/// Compare the distances between markers that usually keep them with their usual values: find swaps, exchange
/// the samples back in the working copy, and mark what remains inconsistent as doubtful.
///
/// Swaps that begin and end while both markers are seen are found by their paths first. Cannot detect swaps
/// during gaps between markers with equal distances to all their neighbours, and single markers that are
/// wrong by
/// less than 10 mm and the usual spread. O(frames markers), and O(markers^2) once.
[[nodiscard]] std::vector<Swap> check_labels(Recording& recording);

}  // namespace kinemark::trajectory::internal
