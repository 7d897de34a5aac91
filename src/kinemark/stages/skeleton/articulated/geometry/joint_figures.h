// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What tells a joint of a body from one that is none, before a geometry is refined.
#pragma once

#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"

namespace kinemark::skeleton::articulated {

/// Distance of a joint from the nearest marker of the segment that it is farther from, m; infinite where it
/// is no number.
[[nodiscard]] double reach_of(const Chain& chain, int joint);

/// RMS change over `frames` of the distance between a joint and that marker of its two segments that keeps it
/// least, m. Markers that are seen in fewer than two of them do not count; infinite where it is no number.
[[nodiscard]] double distance_change(const Chain& chain, const ChainSamples& samples,
                                     const PosedFrames& frames, int joint);

}  // namespace kinemark::skeleton::articulated
