// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Every frame on its own: all poses that fit, joint centres with covariance, and a verdict on whether the
// frame alone determines them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kinemark/stages/skeleton/articulated/chain/chain.h"
#include "kinemark/stages/skeleton/articulated/chain/fitted_chain.h"
#include "kinemark/stages/skeleton/articulated/frame/pose_solver.h"

namespace kinemark::skeleton::articulated {

// What is known of one frame of a chain.

/// Of what a joint's centre is the mean, with the variance of all.
enum class Gathered : char {
  none,       ///< it is that of the best mode
  positions,  ///< several modes
  valley,     ///< the profile of the best mode, which is not Gaussian
};

/// One of the poses that fit a frame.
struct ChainMode {
  ChainPose pose;
  double cost = 0.0;             ///< m^2, weighted
  double weight = 0.0;           ///< share of the probability, 0 to 1
  std::vector<Vector3d> centre;  ///< joints, m
};

/// All that is known of a frame.
struct ChainFrame {
  std::vector<data::CentreState> state;  ///< per joint: undetermined, ambiguous or determined
  std::vector<Vector3d> centre;          ///< per joint, of the best mode (or see gathered), m
  std::vector<Matrix3d> covariance;      ///< per joint, m^2, with the geometry's own part
  std::vector<Matrix3d> own_covariance;  ///< per joint, m^2, geometry held
  std::vector<Matrix3d> information;     ///< per joint, 1/m^2, geometry held; any rank
  std::vector<ChainMode> modes;          ///< best first; one when no other was looked for
  int mode_count = 0;                    ///< entries of `modes` in use
  std::vector<Gathered> gathered;        ///< per joint
  int seen = 0;
};

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
