// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Swings of the feet by their speed over the ground: one leaving before each, one strike after it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "kinemark/stages/analysis/gait/gait_paths.h"

namespace kinemark::analysis {

/// Of the usual greatest speed: a foot below the first stands, above the second swings, between them goes on.
inline constexpr double kStands = 0.25, kSwings = 0.38;

/// How the ground moves under the feet, horizontal: not at all over ground, backwards on a treadmill.
struct Ground {
  Eigen::RowVector2d velocity{0.0, 0.0};  ///< m/s
  double sd = 0.0;  ///< m/s, of its length: half of what heels and toes differ by while they stand
};

/// Frames in which somebody stands: no marker of either foot goes 0.05 m/s, for 0.7 s or more. None where a
/// foot has no markers.
[[nodiscard]] std::vector<bool> quiet_frames(const GaitPaths& paths);

/// The commonest horizontal velocity of heels and toes while they are low (35 mm above their lowest) and do
/// not rise or fall (0.35 m/s), and nobody stands: a mode by mean shift, of width max(0.08 m/s, 3 % of the
/// fast ones).
/// @param near  start from this velocity alone, as in a simulated repetition; empty: from 60 and from 0
[[nodiscard]] Ground ground_velocity(const GaitPaths& paths,
                                     const std::optional<Eigen::RowVector2d>& near = std::nullopt);

/// One swing. Frames at which the speed is below kStands again; nothing where the recording, or what is seen
/// of the foot, begins or ends within it.
struct Swing {
  std::optional<std::int64_t> leaves;  ///< the last before it
  std::int64_t peak = 0;               ///< the greatest speed
  std::optional<std::int64_t> lands;   ///< the first after it
};

/// The swings of one foot.
struct FootSwings {
  std::vector<Swing> swings;  ///< ascending
  Eigen::VectorXd speed;      ///< n, m/s over the ground, of the middle of heel and toe; empty: no such foot
  FrameSpan seen{.first = 0, .last = -1};  ///< from the first to the last frame in which it is known
};

/// Swings of both feet.
struct Steps {
  std::array<FootSwings, 2> feet;  ///< left, right
  Eigen::VectorXd usual;           ///< n, m/s: greatest speed of both feet within 0.7 s, not below 0.35
  double stride_s = 1.1;           ///< usual time from swing to swing of a foot, 0.3 to 2.5
  std::vector<bool> quiet;         ///< n; quiet_frames()
  std::vector<bool> going;         ///< n; within half a stride of a swing: not where somebody stands

  /// Of one foot.
  [[nodiscard]] const FootSwings& foot(data::Side side) const { return feet[data::index_of(side)]; }
};

/// Slope of each column by central differences, one-sided at the ends; per second.
[[nodiscard]] math::SeriesMatrix slopes(const math::SeriesMatrix& x, double rate_hz);
/// Length of the horizontal velocity of a marker over the ground, m/s.
[[nodiscard]] Eigen::VectorXd speed_over_ground(const math::SeriesMatrix& x, double rate_hz,
                                                const Eigen::RowVector2d& ground);

/// The swings: runs above kSwings of the usual speed until below kStands of it, longer than 60 ms and 80 mm
/// over the ground. Within gaps of a foot its speed is that of the straight line across.
[[nodiscard]] Steps find_steps(const GaitPaths& paths, const Eigen::RowVector2d& ground);

/// Cut-off for feet that step at this pace: 10 in a stride, from 6 to 25 Hz.
[[nodiscard]] double cut_off_of(double stride_s);

}  // namespace kinemark::analysis
