// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which frames inform the geometry, and their poses.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/stages/skeleton/articulated/chain/chain.h"
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"

namespace kinemark::skeleton::articulated {

/// At most `most` frames, drawn evenly among those that show two markers or more; `kept` their indices.
[[nodiscard]] ChainSamples thin_out(const ChainSamples& samples, int most, std::vector<std::int64_t>& kept);

/// Frames that show enough for a first fit: three markers (or all) of every segment; when these are few,
/// three of one and two of the others; two lines: two of one.
[[nodiscard]] std::vector<std::int64_t> first_frames(const ChainSamples& samples, const Chain& chain);

/// Best pose of each frame from all starts; in frames that show every joint by the pose of a segment, from
/// the frame before and one more start where these agree. Any number of threads (0: all cores) gives the same
/// bits.
[[nodiscard]] PosedFrames first_poses(const ChainSamples& samples, const Chain& chain,
                                      const std::vector<std::int64_t>& frames,
                                      const std::vector<double>& marker_weight, double sigma_m,
                                      int iterations, int threads = 1);

}  // namespace kinemark::skeleton::articulated
