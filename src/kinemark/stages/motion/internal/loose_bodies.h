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

/// Where bodies are loose.
struct LooseFrames {
  /// F, of each frame with a loose body: a number of those bodies and of which of their markers are seen, 0,
  /// 1,
  /// ... in order of appearance; -1 for all other frames.
  std::vector<std::int64_t> pattern;
  /// Of each pattern, nv: 1 for the speeds of the joints at its loose bodies.
  std::vector<std::vector<std::uint8_t>> speeds;

  [[nodiscard]] bool any() const { return !speeds.empty(); }
};

/// Find the bodies that lack a marker which they have in other frames, are not fixed by what is left, and
/// stay so for `least_s` or longer: over a shorter time the frames beside tell which pose goes on.
///
/// A body is fixed where three points of it that do not lie near a line are known: its markers, the centre of
/// a joint to a body that is fixed, the axis of a hinge to one. Bodies without a joint between them that
/// moves count as one; those behind which no marker is seen are open rather than loose, and are not meant.
/// O(F M) time.
[[nodiscard]] LooseFrames find_loose_frames(const Problem& problem, const data::Trajectories& markers,
                                            double least_s = 0.1);

}  // namespace kinemark::motion::internal
