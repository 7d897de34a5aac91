// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton::internal {

/// `n` evenly spaced frames of a recording, all where it has fewer.
[[nodiscard]] std::vector<std::int64_t> draw_evenly(std::int64_t frames, std::int64_t n);

/// The recording cut to some of its frames: what fits and poses are made of. Mask: F x M, or empty.
[[nodiscard]] data::Trajectories cut(const data::Trajectories& t, const std::vector<std::int64_t>& frames,
                                     const Array<std::uint8_t>& mask = {});

/// How the distance of every pair of markers varies.
struct PairSpread {
  Eigen::MatrixXd variance;     ///< M x M, m^2; NaN for pairs seen together in too few frames
  Eigen::MatrixXd frames;       ///< M x M, seen together
  Eigen::MatrixXd correlation;  ///< M x M, of a distance with its next; NaN as variance
};

/// Over the given frames, in order.
[[nodiscard]] PairSpread measure_pairs(const Samples& samples, const std::vector<int>& markers,
                                       const std::vector<std::int64_t>& frames, std::int64_t least_frames);

/// Statistics of pairs within one segment, from each marker's most constant distances.
struct SameSegment {
  double noise_variance = 0.0;  ///< of a marker, per axis, m^2
  double soft_sd_m = 0.0;
  double independent = 1.0;  ///< independent frames per frame
};
/// Soft tissue, where there is any, is at least `least_soft_m`.
[[nodiscard]] SameSegment describe_same_segment(const PairSpread& pairs, double noise_sd_m,
                                                double least_soft_m = 0.001);

struct OddsOptions {
  double least_motion_m = 0.002, most_motion_m = 0.1;
};
/// Log odds of sharing a segment, M x M, within +-50; 0 for pairs never seen together.
[[nodiscard]] Eigen::MatrixXd log_odds(const PairSpread& pairs, const SameSegment& same,
                                       const OddsOptions& options);

/// Segment of each marker, numbered by first marker: average linkage over seen pairs while it is positive,
/// then single markers move to where they fit better.
[[nodiscard]] std::vector<int> cluster(const Eigen::MatrixXd& odds, const PairSpread& pairs);

/// Noise variance per axis that pairs of markers on one segment show, m^2; NaN without such pairs. Using the
/// most constant pairs alone would bias it downwards.
[[nodiscard]] double noise_within(const PairSpread& pairs, const std::vector<int>& segment);

/// Least odds of marker i with any other of its own segment; 0 when it is alone.
[[nodiscard]] double least_odds(const Eigen::MatrixXd& odds, const PairSpread& pairs,
                                const std::vector<int>& segment, std::size_t i);

/// Mean odds of marker i to the others of segment s; NaN when it was seen with none of them.
[[nodiscard]] double mean_odds(const Eigen::MatrixXd& odds, const PairSpread& pairs,
                               const std::vector<int>& segment, std::size_t i, int s);

}  // namespace kinemark::skeleton::internal
