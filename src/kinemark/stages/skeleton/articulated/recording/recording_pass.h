// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/stages/skeleton/articulated/chain/fitted_chain.h"

namespace kinemark::skeleton::articulated {

/// What one frame says of a point: its position, and with how much information (1/m^2, rank 0 to 3).
struct PathPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

/// True where the information holds all three coordinates.
[[nodiscard]] bool holds_a_position(const PathPoint& point);

/// A point's path through time.
struct SmoothedPath {
  std::vector<Eigen::Vector3d> position;  ///< F, m; NaN where the path is not known
  Array<double> covariance;               ///< F x 6 (xx xy xz yy yz zz), m^2; NaN likewise

  [[nodiscard]] bool known(std::size_t frame) const { return position[frame].allFinite(); }
  [[nodiscard]] Eigen::Matrix3d covariance_at(std::size_t frame) const;
};

/// Position of a point under jerk that is white noise of density `white_jerk` (m^2/s^5), given all frames,
/// which may be of any rank. Stretches of more than a second in which no frame holds a position are left
/// unknown but for their first and last half second. O(F) time. The smoother is math::smooth_wiener() of
/// order 3.
[[nodiscard]] SmoothedPath smooth_path(std::span<const PathPoint> points, double rate_hz, double white_jerk);

/// Log likelihood of the positions given such a path, up to a constant that the points alone fix.
[[nodiscard]] double calc_path_likelihood(std::span<const PathPoint> points, double rate_hz,
                                          double white_jerk);

/// How fast a point moves.
struct PathPrior {
  double white_jerk = 0.0;  ///< m^2/s^5, the likeliest
  bool follows = false;     ///< the frames follow each other: such a path explains them better than none
};

/// The likeliest density of jerk, from up to `max_frames` frames in four windows. `follows` compares with
/// positions that are independent from frame to frame.
[[nodiscard]] PathPrior find_path_prior(std::span<const PathPoint> points, double rate_hz,
                                        std::int64_t max_frames = 2000);

/// Positions of all joints that fit a frame, where others fit as well.
struct FlaggedMode {
  std::vector<Vector3d> centre;  ///< J, m
  double log_weight = 0.0;       ///< of the frame's probability
};

/// A frame in which some joint is not determined by the frame's own markers, or by several positions
/// together.
struct FlaggedFrame {
  std::int64_t frame = 0;
  std::vector<FlaggedMode> modes;  ///< best first
  std::vector<char> gathered;      ///< J, not 0: determined as the mean of several of them
};

/// A frame's pose, kept for findings about the whole recording.
struct SampledPose {
  std::int64_t frame = 0;
  ChainPose pose;
  double cost = 0.0;                ///< m^2
  std::vector<std::uint8_t> known;  ///< J: determined in this frame
};

/// What every frame determines by itself; J joints of the chain, F frames.
struct RecordingPass {
  std::vector<std::vector<PathPoint>> points;         ///< J of F; no information where not determined
  std::vector<std::vector<data::CentreState>> state;  ///< J of F
  std::vector<Array<double>> covariance;              ///< J of F x 6, m^2, with the geometry's part
  std::vector<Array<double>> common;                  ///< J of F x 6, m^2: the geometry's part alone
  std::vector<FlaggedFrame> flagged;                  ///< in order of time
  std::vector<SampledPose> sampled;   ///< up to 4,000, evenly spread; of every joint that any frame shows
  std::vector<std::int64_t> misfits;  ///< frames that the geometry does not explain
};

/// Upper triangle of a symmetric matrix, as data::Skeleton stores it.
void store_symmetric(double* to, const Matrix3d& C);
[[nodiscard]] Matrix3d load_symmetric(const double* from);

/// Solve all frames of a recording with a fitted geometry, in chunks that do not depend on `threads`. Every
/// frame costs the same however long the recording is.
[[nodiscard]] Result<RecordingPass> pass_over(const FittedChain& fit, const ChainSamples& samples,
                                              int threads, const Progress& progress);

/// True where a frame's cost is beyond what noise explains: six standard deviations of its chi-square.
[[nodiscard]] bool is_misfit(const Chain& chain, double cost_m2, double noise_sd_m, int seen);

}  // namespace kinemark::skeleton::articulated
