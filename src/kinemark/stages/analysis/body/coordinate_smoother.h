// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One coordinate of a motion, smoothed, and simulated again with its own errors.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/math/difference_smoother.h"
#include "kinemark/stages/analysis/path/refits.h"

namespace kinemark::analysis {

/// How wrong the samples of a coordinate are.
struct CoordinateNoise {
  double white = 0.0;  ///< SD from sample to sample, from sixth differences; rad or m
  /// SD of what changes as slowly as the movement does: by how much the stated deviation exceeds `white`.
  double slow = 0.0;
};

/// Samples of one coordinate with what their errors do.
///
/// White errors are smoothed away and known from the samples themselves. What refits are made of rests where
/// the smoothed coordinate moves by no more than noise does. A stated deviation that is more than
/// 15 % larger holds errors which no smoothing removes: skin that slides with the pose, noise that was
/// filtered before. As nothing tells them from the movement, they are drawn as it goes: a third of their
/// variance along the pose, a third along the poses of what moves beside it (along its own where nothing
/// does), a sixth along its rate, a sixth as 16 cosines between a quarter of and twice the mean frequency of
/// the movement (Rice 1945).
class CoordinateSmoother {
 public:
  /// @param q       n samples, finite; those that are not `seen` may be anything
  /// @param seen    n flags
  /// @param stated  deviation of a sample as the motion states it, root mean square; NaN: not stated
  /// @return        a sentence where fewer than 30 samples are seen
  [[nodiscard]] static std::expected<CoordinateSmoother, std::string> create(const Eigen::VectorXd& q,
                                                                             std::vector<bool> seen,
                                                                             double stated, double rate_hz);

  /// What else moves, and drags skin along.
  /// @param poses  n x C, each of mean 0 and variance 1, or 0 where it rests
  /// @param own    the column of this coordinate, which is left out
  void move_beside(std::shared_ptr<const Eigen::MatrixXd> poses, Eigen::Index own);

  [[nodiscard]] const CoordinateNoise& noise() const { return noise_; }    ///< as found and as stated
  [[nodiscard]] double cut_off_hz() const { return cut_off_hz_; }          ///< half power; NaN: not smoothed
  [[nodiscard]] const Eigen::VectorXd& estimate() const { return less_; }  ///< at kLessSmooth
  [[nodiscard]] const Eigen::VectorXd& pilot() const { return pilot_; }    ///< what refits are made of
  /// The pilot smoothed as the estimate is: what refits have without errors.
  [[nodiscard]] Eigen::VectorXd smoothed_pilot() const;
  /// The pilot with errors of both kinds, smoothed as the estimate is. Stream (stream, k) of the seed.
  [[nodiscard]] Eigen::VectorXd refit(std::uint64_t seed, std::uint64_t stream, std::int64_t k) const;

  /// The deviations of slow errors alone, at n samples.
  [[nodiscard]] Eigen::VectorXd slow_errors(std::uint64_t seed, std::uint64_t stream, std::int64_t k) const;

 private:
  Recording recording_;
  std::optional<math::DifferenceSmoother> smoother_;  // none: the samples show no noise
  CoordinateNoise noise_;
  double cut_off_hz_ = kNaN;
  double movement_hz_ = 0.0;
  Eigen::VectorXd less_, pilot_;
  std::shared_ptr<const Eigen::MatrixXd> poses_;  // null: nothing moves beside it
  Eigen::Index own_pose_ = 0;
};

/// Of mean 0 and variance 1; 0 where it is constant.
[[nodiscard]] Eigen::VectorXd standardized(const Eigen::VectorXd& x);

}  // namespace kinemark::analysis
