// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Samples of a marker that cannot be where it was: leaps there and back, and places held while it went on.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/data/trajectories.h"

namespace kinemark::analysis {

/// Frames [first, last] of a recording.
struct FrameSpan {
  std::int64_t first = 0, last = 0;  ///< both within
  /// Number of frames.
  [[nodiscard]] std::int64_t count() const { return last - first + 1; }
};

/// What of a marker's samples is believed.
struct SamplesBelieved {
  std::vector<bool> seen;       ///< n: measured, and none of the following
  std::int64_t leaps = 0;       ///< samples that leap there and back
  std::vector<FrameSpan> held;  ///< stretches in which the marker does not move by one bit
};

/// Judge the measured samples of a marker.
///
/// A sample leaps where it lies farther from the middle of its two neighbours than max(60 mm, 60 m/s^2 /
/// rate^2) and 6 times the median of that distance. Three equal samples or more are held where they end in a
/// leap of 30 mm that is three times the next step; so are 0.6 s of equal samples in a file that resolves
/// less than 0.02 mm. Equal samples alone are not: files of whole numbers hold feet that stand.
[[nodiscard]] SamplesBelieved believe_samples(const data::Trajectories& markers, std::int64_t marker);

}  // namespace kinemark::analysis
