// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joints whose covariance the motion alone would make too small: under skin that slides with the posture, and
// in directions that the motion does not determine.
#pragma once

#include <vector>

#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/skeleton/articulated/recording/recording_pass.h"

namespace kinemark::skeleton::articulated {

/// Along a hinge's axis nothing is known: its SD becomes `size_m` there, in both segments and in every frame
/// that has a centre. `axis` is in the axes of `chain_segment`, whose rotation is that of the last sampled
/// pose (before the first one: of the first): it gives a direction only, so a pose nearby in time is enough.
void widen_along_axis(const std::vector<SampledPose>& sampled, int chain_segment, const Vector3d& axis,
                      int joint, double size_m, data::Skeleton& skeleton);

/// A joint that did not move may lie anywhere about its segments: what seems to be motion is noise. Adds an
/// SD of `size_m` in every direction.
void widen_all_around(int joint, double size_m, data::Skeleton& skeleton);

/// Likelihood under noise that differs from frame to frame trusts a movement that repeats itself too much.
/// Where the gap between the two places of a joint shows that skin more likely slides with the posture than
/// not (measure_skin_slide()), the joint stays where it is, and its covariance is widened by what the slide
/// leaves of the place where the gap is least, and by the square of the distance to that place; so are those
/// of its centres in all frames that show the segments' poses, and of its lengths. A hinge's axis gets the
/// tilts by skin that turns with it. Joints between segments without poses (lines) are left as they are. O(F
/// M).
void account_for_skin(const data::Trajectories& markers, data::Skeleton& skeleton);

}  // namespace kinemark::skeleton::articulated
