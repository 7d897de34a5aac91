// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Bodies that the markers of a frame leave loose: only there more than one pose may fit. Theory:
// docs/theory/error-bars.md
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {

/// Number of the pattern of markers in each frame in which a body lacks a marker that it has in others and is
/// loose; -1 for all other frames.
///
/// A body is fixed where three points of it that do not lie near a line are known: its markers, the centre of
/// a joint to a body that is fixed, the axis of a hinge to one. Bodies without a joint between them that
/// moves count as one; those behind which no marker is seen are open rather than loose, and are not meant.
/// F numbers; 0, 1, ... in order of appearance. O(F M) time.
[[nodiscard]] std::vector<std::int64_t> find_loose_frames(const Problem& problem,
                                                          const data::Trajectories& markers);

}  // namespace kinemark::motion::internal
