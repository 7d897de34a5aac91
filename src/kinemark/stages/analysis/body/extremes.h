// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Extremes of a curve without the luck of the largest of noisy values. NaN samples of a curve do not count.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "kinemark/core/missing.h"

namespace kinemark::analysis {

/// Which number of a curve is meant.
enum class Pick : std::uint8_t {
  largest,           ///< its largest value
  smallest,          ///< its smallest value
  range,             ///< the largest less the smallest
  size,              ///< the largest absolute value
  time_of_largest,   ///< the sample of the largest value, the first of equal ones
  time_of_smallest,  ///< of the smallest
  mean_size,  ///< mean length in time of vectors, three values each: the largest component of each in any
              ///< direction
};

/// That number; NaN of a curve without values.
[[nodiscard]] double picked(Pick pick, const Eigen::VectorXd& curve);

/// The place of the extreme from curve + noise and its value from curve - noise, and the other way round: the
/// mean of both. Where `noise` is distributed as that of the curve, the noise of both is independent, so that
/// the largest is not the luckiest (coupled bootstrap: Oliveira, Lei & Tibshirani 2021). Of vectors the
/// direction from one and the component from the other: noise alone has no length. Not of times.
[[nodiscard]] double thinned(Pick pick, const Eigen::VectorXd& curve, const Eigen::VectorXd& noise);

/// Samples that may be the extreme one.
struct PossibleInstants {
  Eigen::Index first = 0, last = 0;  ///< the earliest and the latest
};

/// Differences between a curve's extreme and its other samples beside what noise does to them.
class InstantSet {
 public:
  /// @param pick  time_of_largest or time_of_smallest
  InstantSet(Pick pick, const Eigen::VectorXd& curve);

  void add(const Eigen::VectorXd& noise);  ///< one draw of the curve's noise

  /// Samples whose value is as extreme within `deviations` standard deviations of the difference.
  [[nodiscard]] PossibleInstants within(double deviations) const;

 private:
  Eigen::VectorXd below_;  ///< by how much each sample lies behind the extreme one, not below 0
  Eigen::VectorXd sum_, squares_;
  Eigen::Index extreme_ = 0;
  double sign_ = 1.0, count_ = 0.0;
};

}  // namespace kinemark::analysis
