// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Where a limb begins and ends: the point of a segment that stays in the room, and a marker at its tip.
// Theory: docs/theory/joint-centres-ends.md
#pragma once

#include <span>

#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skeleton {

/// Adds `ends` to a skeleton whose segments hold the positions of their markers, in the recording's frames.
///
/// A point that stays is SCoRE's of the segment against the room, half-way to the place that slides of skin
/// make likely; it has one position in all frames. That it does not stay is a warning. An end is its marker's
/// position on the segment, carried by the segment's pose and smoothed in time where frames follow each
/// other; it is known also where the marker is not seen. Neither is placed, with a warning, where the segment
/// was left out or shows no pose (three markers that are not on a line). O(F M).
void place_ends(const data::Trajectories& markers, std::span<const data::SegmentLayout::End> ends,
                data::Skeleton& skeleton);

}  // namespace kinemark::skeleton
