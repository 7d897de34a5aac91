// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Steps of the geometry's fit: which frames, their poses, mirrored geometries.
#pragma once

#include "kinemark/stages/skeleton/articulated/geometry/fit_chain.h"
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"

namespace kinemark::skeleton {

/// At most `most` frames, drawn evenly among those that show two markers or more; `kept` their indices.
[[nodiscard]] ChainSamples thin_out(const ChainSamples& samples, int most, std::vector<std::int64_t>& kept);

/// Frames that show enough for a first fit: three markers (or all) of every segment; when these are few,
/// three of one and two of the others; two lines: two of one.
[[nodiscard]] std::vector<std::int64_t> first_frames(const ChainSamples& samples, const Chain& chain);

/// Best pose of each frame from all starts.
[[nodiscard]] GlobalFrames first_poses(const ChainSamples& samples, const Chain& chain,
                                       const std::vector<std::int64_t>& frames,
                                       const std::vector<double>& marker_weight, double sigma_m,
                                       int iterations);

/// Refit from the joints reflected at their segments' planes of markers. Takes a better geometry into
/// `fit.chain` (true) and notes by how much the best different one is worse.
bool try_twins(const ChainSamples& samples, const GlobalFrames& frames, ChainFit& fit);

/// Where a hinge lies along its axis the motion leaves open. Refits the geometry with these joints held there
/// to the point of the axis that is nearest to the markers of both segments; noise and weights stay.
void hold_hinges(const ChainSamples& samples, const std::vector<HingeAxis>& hinges, ChainFit& fit);

}  // namespace kinemark::skeleton
