// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Poses to begin from in a frame: all that follow from the seen markers in closed form.
#pragma once

#include <span>
#include <vector>

#include "kinemark/stages/skeleton/articulated/frame/pose_solver.h"

namespace kinemark::skeleton::articulated {

/// Starts for the frame that `solver` was given. `x` the same frame's coordinates.
class PoseStarts {
 public:
  explicit PoseStarts(const Chain& chain);

  /// All starts: the rigid pose of each segment, the same rotated by half a turn about the long axis of its
  /// seen markers, and two trilaterations of every joint from the markers of its two segments, on either side
  /// of their plane; the other segments follow joint by joint. Two lines: the two starts that their
  /// likelihood gives in closed form, which are enough. In longer chains a joint beside a segment that shows
  /// its pose beside noise of `sigma_m` has one position: starts are those of the other joints and their
  /// segments, and the rigid pose of that segment alone which shows most markers of those that show theirs.
  void find(const PoseSolver& solver, const double* x, double sigma_m);
  [[nodiscard]] std::span<const ChainPose> poses() const {
    return {poses_.data(), static_cast<std::size_t>(count_)};
  }

  /// The rigid pose of the segment that shows most markers (the first of them); the others follow joint by
  /// joint. One marker at least must be seen.
  const ChainPose& find_rigid(const PoseSolver& solver);

  /// Rotations that fit best for joints held at these positions, m.
  void from_centres(const PoseSolver& solver, std::span<const Vector3d> centres, ChainPose& out);

 private:
  ChainPose& next();
  /// Best rotation of a segment one point of which (in its axes) is held at `position` (from the sums'
  /// centre).
  [[nodiscard]] Matrix3d rotation_about(const PoseSolver& solver, int segment, const Vector3d& point,
                                        const Vector3d& position) const;
  /// Poses of all segments that have none yet, each rotated about the joint that leads to it.
  void complete(const PoseSolver& solver, ChainPose& pose);
  void anchor(const PoseSolver& solver, int segment);
  void trilaterate(const PoseSolver& solver, const double* x, int joint);
  void two_lines(const PoseSolver& solver);

  const Chain* chain_;
  std::vector<ChainPose> poses_;
  std::vector<char> done_, wanted_;
  std::vector<Vector3d> origin_;
  int count_ = 0;
};

}  // namespace kinemark::skeleton::articulated
