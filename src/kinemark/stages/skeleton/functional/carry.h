// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skeleton {

/// Centres of a skeleton in another recording of the same markers, as from a functional trial to a walk.
///
/// Markers are found by name; segments are posed with the skeleton's own shapes (Kabsch, three markers not on
/// a line), and each centre is the mean of its positions by the segments that have a pose. The covariance
/// contains that of the skeleton's centres and the noise of the poses, which is estimated from the deviations
/// of the markers from those shapes; skin that has shifted and a gap between the two positions widen it.
/// Code::bad_input when no segment of a joint has three of its markers here. O(F M).
[[nodiscard]] Result<data::Skeleton> carry_joints(const data::Skeleton& skeleton,
                                                  const data::Trajectories& recording);

}  // namespace kinemark::skeleton
