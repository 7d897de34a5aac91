// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Every frame on its own: all poses that fit, joint centres with covariance, and a verdict on whether the
// frame alone determines them.
#pragma once

#include <memory>
#include <span>

#include "kinemark/stages/skeleton/articulated/chain/fitted_chain.h"
#include "kinemark/stages/skeleton/articulated/frame/chain_frame.h"
#include "kinemark/stages/skeleton/articulated/frame/pose_solver.h"

namespace kinemark::skeleton::articulated {

/// Solves frames for a fitted geometry, one after the other; owns its memory, so that a recording of any
/// length streams through.
class ChainSolver {
 public:
  explicit ChainSolver(const FittedChain& fit);
  ~ChainSolver();
  ChainSolver(ChainSolver&&) noexcept;
  ChainSolver& operator=(ChainSolver&&) noexcept;
  ChainSolver(const ChainSolver&) = delete;
  ChainSolver& operator=(const ChainSolver&) = delete;

  /// One frame, K x 3. `warm`: the pose of the frame before, or null. Every start is tried unless the frame
  /// follows `warm` with a cost below its chi-square and some segment next to every joint shows three
  /// markers.
  void solve(const double* x, const ChainPose* warm, ChainFrame& out);
  /// The frame's minimum next to `start` with joints known beforehand; pose, centre, covariance and
  /// information (both without the priors) in `out`, state left as `bridged`. Returns the cost without the
  /// priors' part, m^2.
  double solve_near(const double* x, const ChainPose& start, std::span<const JointPrior> priors,
                    ChainFrame& out);
  /// Rotations of all segments that fit best for joints at these positions: a start for solve_near().
  void pose_from_centres(const double* x, std::span<const Vector3d> centres, ChainPose& out);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace kinemark::skeleton::articulated
