// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Parts of a body that were solved each by itself, as one result.
#pragma once

#include <string>
#include <vector>

#include "kinemark/data/skeleton.h"

namespace kinemark::workflow {

/// "segment 'pelvis'", "segments 'pelvis' and 'thigh'", "segments 'a', 'b' and 4 more".
[[nodiscard]] std::string names_of(const data::SegmentLayout& layout);

/// Segments and joints of a layout behind those of another.
void append(const data::SegmentLayout& layout, data::SegmentLayout& to);

/// Skeletons of one recording, none of which has a segment of another, one behind the other; one at least.
/// Noise: RMS over all markers placed.
[[nodiscard]] data::Skeleton join_skeletons(std::vector<data::Skeleton> parts);

}  // namespace kinemark::workflow
