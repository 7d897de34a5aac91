// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Bodies that the markers of a frame leave loose: only there more than one pose may fit. Theory:
// docs/theory/error-bars.md
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {

/// A body all of whose known points lie on a line through its joint: it turns about that line unseen, or the
/// other way round with what hangs on it.
struct UnseenTurn {
  int body = 0;
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();  ///< the line, in the body's axes; length 1
};

/// Where bodies are loose.
struct LooseFrames {
  /// F, of each frame with a loose body: a number of those bodies and of which of their markers are seen, 0,
  /// 1,
  /// ... in order of appearance; -1 for all other frames.
  std::vector<std::int64_t> pattern;
  /// Of each pattern, nv: 1 for the speeds of the joints at its loose bodies.
  std::vector<std::vector<std::uint8_t>> speeds;
  /// nv: 1 for the speeds of the joints at bodies that all markers together leave loose, in every frame then;
  /// empty: none does.
  std::vector<std::uint8_t> never_fixed;
  std::vector<UnseenTurn> turns;  ///< of these bodies

  [[nodiscard]] bool any() const { return !speeds.empty(); }
};

/// Find the bodies that lack a marker which they have in other frames, are not fixed by what is left, and
/// stay so for `least_s` or longer: over a shorter time the frames beside tell which pose goes on. And those
/// that all markers together leave loose (one marker at each joint), where `with_few` asks for them.
///
/// A body is fixed where three points of it that do not lie near a line are known: its markers, the centre of
/// a joint to a body that is fixed, the axis of a hinge to one. Bodies without a joint between them that
/// moves count as one; those behind which no marker is seen are open rather than loose, and are not meant.
/// O(F M) time.
[[nodiscard]] LooseFrames find_loose_frames(const Problem& problem, const data::Trajectories& markers,
                                            double least_s = 0.1, bool with_few = true);

}  // namespace kinemark::motion::internal
