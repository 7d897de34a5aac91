// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which observations of a recording of counts can be relied on.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/data/counts.h"

namespace kinemark::camera {

/// F x L x C (Counts::index): 1 where the observation is complete, not occluded, not saturated, and its light
/// (the sum of the four counts) is more than `dim_share` of the median of that LED in that camera, and more
/// than offsets and stray light alone reach.
///
/// @param counts     valid; saturated observations count in the median, as light that is there
/// @param dim_share  0 to 1
/// O(F L C).
[[nodiscard]] std::vector<std::uint8_t> usable_views(const data::Counts& counts, double dim_share);

}  // namespace kinemark::camera
