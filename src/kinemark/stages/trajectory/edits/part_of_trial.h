// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "kinemark/data/trial.h"

namespace kinemark::trajectory {

/// Consecutive frames of a recording.
struct FrameSpan {
  std::int64_t first = 0;  ///< index, not number
  std::int64_t count = 0;  ///< 0: none
};

/// Leaves some frames, markers and channels of `trial`, with all that is known of their samples, in the order
/// of the indices. Frames keep their numbers and times; analog samples go from the first frame to the end of
/// the last; events outside are left out, which the warnings say. O(samples).
void keep_part(data::Trial& trial, const FrameSpan& frames, std::span<const std::int64_t> markers,
               std::span<const std::int64_t> channels);
/// The same with all markers and channels.
void keep_frames(data::Trial& trial, const FrameSpan& frames);
/// The same with all frames and channels.
void keep_markers(data::Trial& trial, std::span<const std::int64_t> markers);

}  // namespace kinemark::trajectory
