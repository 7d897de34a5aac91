// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which observations of a recording of counts can be relied on.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/data/counts.h"

namespace kinemark::camera {

/// F x L x C (Counts::index): 1 where the observation is complete, not occluded, saturated in one channel at
/// most (see kept_channels()), and its light (the sum of the four counts) is more than `dim_share` of the
/// median of that LED in that camera, and more than offsets and stray light alone reach.
///
/// @param counts     valid; saturated observations count in the median, as light that is there
/// @param dim_share  0 to 1
/// O(F L C).
[[nodiscard]] std::vector<std::uint8_t> usable_views(const data::Counts& counts, double dim_share);

/// 1 for each channel of an observation that is below the converter's highest code, 0 for one that stands at
/// it: how much more it would read is not known. Three channels still give a point and the light. O(1).
[[nodiscard]] inline Eigen::Vector4d kept_channels(const Eigen::Vector4d& read, std::int16_t highest_code) {
  return (read.array() < static_cast<double>(highest_code)).cast<double>();
}

}  // namespace kinemark::camera
