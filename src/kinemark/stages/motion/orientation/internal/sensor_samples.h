// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Samples of single sensors that are wrong: for a few frames the sensor is turned against those beside.
// Theory: docs/theory/orientations.md
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kinemark/core/time_base.h"
#include "kinemark/data/orientations.h"
#include "kinemark/stages/motion/orientation/orientation_ik.h"

namespace kinemark::motion::internal {

/// The orientations at other instants of the same clock, by spherical interpolation between the two samples
/// beside. An instant within a tenth of a sample from one takes that one. Missing before the first and after
/// the last sample, and where one of the two beside is missing.
[[nodiscard]] data::Orientations at_times(const data::Orientations& recording, const TimeBase& time);

/// Longest span that is judged wrong, in samples. Longer ones may as well be right.
inline constexpr std::int64_t kMostWrong = 10;

/// Samples of one sensor that are turned against those before and after.
struct TurnedSpan {
  std::int64_t sensor = 0;           ///< index in the recording
  std::int64_t first = 0, last = 0;  ///< frames of the recording, both ends included
  double angle_rad = 0.0;            ///< largest turn against what the samples beside it say
};

/// Spans of up to kMostWrong samples into and out of which a sensor jumps, by sensor and in order. A jump is
/// a sample that is 15 deg or more, and six times their usual distance, off where the three samples before
/// would take it, or the three after. At the ends of a recording and beside missing samples one jump will do.
/// A sensor that stays turned is not accused: nobody can say which side is wrong. O(F S).
[[nodiscard]] std::vector<TurnedSpan> find_turned_spans(const data::Orientations& recording);

/// Recording and pose without the samples that are wrong.
struct JudgedSensors {
  data::Orientations recording;
  std::optional<data::Orientations> pose;  ///< where there is one
  std::vector<TurnedSpan> in_recording, in_pose;

  [[nodiscard]] const data::Orientations* pose_or_null() const { return pose ? &*pose : nullptr; }
  /// Name in the fit what was left out of its sensors, in the frames that were solved and in the pose.
  void account(const TimeBase& solved, OrientationFit& fit) const;
};

/// Judge both. @param pose  null: there is none
[[nodiscard]] JudgedSensors judge_sensors(const data::Orientations& recording,
                                          const data::Orientations* pose);

}  // namespace kinemark::motion::internal
