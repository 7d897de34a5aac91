// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Covariances of joints in directions that the motion does not determine.
#pragma once

#include <vector>

#include "kinemark/data/skeleton.h"
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

}  // namespace kinemark::skeleton::articulated
