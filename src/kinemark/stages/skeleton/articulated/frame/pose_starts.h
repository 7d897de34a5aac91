// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Where to begin in a frame: every way to lay the chain onto the seen markers that is in closed form.
#pragma once

#include <span>
#include <vector>

#include "kinemark/stages/skeleton/articulated/frame/frame_fit.h"

namespace kinemark::skeleton {

/// Starts for the frame that `solver` was given. `x` the same frame's coordinates.
class ChainStarts {
 public:
  explicit ChainStarts(const Chain& chain);

  /// All starts: each segment's rigid pose as anchor, the same turned by half a turn about the long axis of
  /// its seen markers, and two trilaterations of every joint from the markers of its two segments, on either
  /// side of their plane. Two lines: the two closed starts of their likelihood, which are enough.
  void find(const FrameSolver& solver, const double* x);
  [[nodiscard]] std::span<const ChainPose> poses() const {
    return {poses_.data(), static_cast<std::size_t>(count_)};
  }

  /// Rotations that fit best for joints held at these places, m.
  void from_centres(const FrameSolver& solver, std::span<const Vector3d> centres, ChainPose& out);

 private:
  ChainPose& next();
  /// Rotation of a segment about a point of it (in its axes) that is held at a place (about the sums'
  /// centre).
  [[nodiscard]] Matrix3d about(const FrameSolver& solver, int segment, const Vector3d& point,
                               const Vector3d& place) const;
  /// Poses of all segments not `done`, each turned about the joint through which it was reached.
  void spread(const FrameSolver& solver, ChainPose& pose);
  void anchor(const FrameSolver& solver, int segment);
  void trilaterate(const FrameSolver& solver, const double* x, int joint);
  void two_lines(const FrameSolver& solver);

  const Chain* chain_;
  std::vector<ChainPose> poses_;
  std::vector<char> done_;
  std::vector<Vector3d> origin_;
  int count_ = 0;
};

}  // namespace kinemark::skeleton
