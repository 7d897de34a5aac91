// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which kind of segment the data support: line, plane or solid.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"

namespace kinemark::skeleton::articulated {

/// Log evidence of all frames: Laplace's integral over each frame's pose, BIC for the geometry parameters.
/// Priors: one volume for positions, the sphere for a line's direction, all rotations for a plane or solid. A
/// rotation that the data hardly determine is integrated over its circle.
[[nodiscard]] double log_evidence(const Chain& chain, const ChainSamples& samples, const PosedFrames& frames,
                                  double sigma_m);

/// Scatter of a segment's markers across each frame's best line, in frames that show all of them, compared
/// with noise alone: normal deviate of a chi-square with 2 (n - 2) degrees of freedom a frame. 0 with fewer
/// than three frames or three markers.
[[nodiscard]] double across_line(const ChainSamples& samples, std::span<const int> markers, double sigma_m);

/// As across_line(): how far a segment's markers leave a plane. 0 below four markers.
[[nodiscard]] double across_plane(const ChainSamples& samples, std::span<const int> markers, double sigma_m);

/// Kind of every segment. A line is taken unless another kind is better by some tens of nats: its error is
/// the smaller one where the two are near. `sigma_m` 0: estimated with all segments solid.
/// `stopped` (empty: never) is asked before every trial; true ends the work with Code::cancelled. Any number
/// of threads (0: all cores) gives the same bits.
[[nodiscard]] Result<std::vector<data::SegmentKind>> choose_kinds(const ChainSamples& samples,
                                                                  const ChainLayout& layout, double sigma_m,
                                                                  const std::function<bool()>& stopped = {},
                                                                  int threads = 1);

}  // namespace kinemark::skeleton::articulated
