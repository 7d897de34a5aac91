// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How a belt moves, as the feet on it tell: at one speed, or at one that changes.
#pragma once

#include <vector>

#include "kinemark/stages/analysis/gait/swings.h"

namespace kinemark::analysis {

/// How a belt moves, better than the commonest velocity tells: the median over stances of heel and toe from
/// 30 to 55 % of each. As `ground` where no stance is seen whole.
[[nodiscard]] Ground belt_velocity(const GaitPaths& paths, const Steps& steps, const Ground& ground);

/// Speeds of a belt, one of each stance, in the middle of what it is measured from.
struct BeltPace {
  std::vector<double> frame;           ///< ascending
  std::vector<double> m_per_s;         ///< along `along`
  Eigen::RowVector2d along{0.0, 0.0};  ///< of length 1: where the belt goes

  /// Whether the speed changes: six stances or more, a range of 3 % of the mean, and from one stance to the
  /// next much less than in all (von Neumann's ratio below 0.5; 2 where they scatter by chance).
  [[nodiscard]] bool changes() const;
  /// One standard deviation of each speed about a line through its neighbours; of three or more.
  [[nodiscard]] double scatter() const;
  /// n x 2, m: how far the belt is ahead of one of the given speed, linear between stances, even before the
  /// first and after the last.
  [[nodiscard]] math::SeriesMatrix ahead_of(double even_m_per_s, std::int64_t frames, double rate_hz) const;
};
/// Of all stances that are seen whole.
/// @param paths  in the laboratory
/// @param belt   not 0: where it goes
[[nodiscard]] BeltPace belt_pace(const GaitPaths& paths, const Steps& steps, const Eigen::RowVector2d& belt);

}  // namespace kinemark::analysis
