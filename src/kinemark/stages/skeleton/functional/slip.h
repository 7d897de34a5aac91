// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/finding.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skeleton {

/// Options of find_slips().
struct SlipOptions {
  double sure_sd = 5.0;    ///< > 0; shifts below so many of their SDs are not reported
  double least_m = 0.002;  ///< >= 0; smaller ones do not matter

  /// Ranges hold.
  [[nodiscard]] Status check() const;
};

/// Compares the shape of every segment, and the position of every ball joint in it, before and after. A
/// marker's position in its segment is compared across the frame of the largest cumulative deviation; joints
/// between the first and the second half. SDs are of blocks of frames, so slow soft-tissue motion counts as
/// noise.
/// Code::bad_input when the layout does not fit. O(F M).
/// @return  `marker_slip` of markers and `joint_slip` of joints, which show that all markers of a segment
/// moved
///          together; the segment as partner, from about which frame on, how far and its SD, m
[[nodiscard]] Result<std::vector<data::Finding>> find_slips(const data::Trajectories& trajectories,
                                                            const data::SegmentLayout& layout,
                                                            const SlipOptions& options = {});

/// Whether a joint slip is no more than the joint's own doubt. The difference of two halves has four times
/// the variance of the whole recording, by its repeatability, or by its accuracy where that is not known; a
/// joint without either slips nowhere. Across the axis for a hinge. False for what is no joint slip of the
/// skeleton.
[[nodiscard]] bool is_within_repeatability(const data::Finding& slip, const data::Skeleton& skeleton);

}  // namespace kinemark::skeleton
