// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Markers and the frames that show all of them, where no frame shows every marker.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton::internal {

/// Some markers and every frame that shows all of them; empty where there are none.
struct CompleteSet {
  std::vector<int> markers;          ///< of the recording, the parent's first
  std::vector<std::int64_t> frames;  ///< in order of time
};

/// Frames that show all of these markers.
[[nodiscard]] std::vector<std::int64_t> frames_that_show(const Samples& samples,
                                                         const std::vector<int>& markers);

/// The most markers, and with as many the most frames, that leave `least_frames` frames and three markers of
/// each segment; failing that two of each, then 30 frames, then two. Exact for 20 markers and fewer, O(F K +
/// K 2^K); for more, markers are added to every pair one by one as they cost the fewest frames.
[[nodiscard]] CompleteSet find_complete_set(const Samples& samples, const std::vector<int>& parent,
                                            const std::vector<int>& child, std::int64_t least_frames = 100);

}  // namespace kinemark::skeleton::internal
