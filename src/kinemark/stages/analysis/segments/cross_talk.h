// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Whether a knee's varus is its flexion seen about a wrong axis.
#pragma once

#include <optional>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

namespace kinemark::analysis {

/// How the second component of an angle goes with the first.
struct CrossTalk {
  double correlation = 0.0;  ///< Pearson's
  double flexion_rad = 0.0;  ///< range of the first component
  double carried_rad = 0.0;  ///< what the second changes over that range on the line of least squares
  std::int64_t frames = 0;   ///< with both

  /// The line explains at least half of the second component's variance.
  [[nodiscard]] bool follows() const;
  /// It follows(), and by 5 deg at least (Baudet et al. 2014 take an axis for wrong that leaves
  /// varus correlated with flexion).
  [[nodiscard]] bool suspicious() const;
  /// What to say of it, a sentence; it claims cross-talk where it is suspicious() alone.
  [[nodiscard]] std::string sentence(const std::string& name) const;
};

/// Of the frames that have both; none with fewer than 10, or where the first ranges over less than 20 deg: a
/// knee that hardly flexes tells nothing of its axis.
[[nodiscard]] std::optional<CrossTalk> find_cross_talk(const SegmentSeries& knee);

}  // namespace kinemark::analysis
