// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joints of a skeleton under skin that slides with the posture.
#pragma once

#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skeleton::articulated {

/// Likelihood under noise that differs from frame to frame trusts a movement that repeats itself too much.
/// Where the gap between the two places of a joint shows that skin more likely slides with the posture than
/// not (measure_skin_slide()), the joint stays where it is, and its covariance is widened by what the slide
/// leaves of the place where the gap is least, and by the square of the distance to that place; so are those
/// of its centres in all frames that show the segments' poses, and of its lengths. A hinge's axis gets the
/// tilts by skin that turns with it. Joints between segments without poses (lines) are left as they are. O(F
/// M).
void account_for_skin(const data::Trajectories& markers, data::Skeleton& skeleton);

}  // namespace kinemark::skeleton::articulated
