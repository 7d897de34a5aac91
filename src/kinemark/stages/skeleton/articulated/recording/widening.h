// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Covariances of joints in directions of which the motion says nothing.
#pragma once

#include <vector>

#include "kinemark/data/skeleton.h"
#include "kinemark/stages/skeleton/articulated/recording/recording_pass.h"

namespace kinemark::skeleton::internal {

/// Along a hinge's axis nothing is known: its SD becomes `size_m` there, in both segments and in every frame
/// that has a centre. `axis` is in the axes of `chain_segment`, whose turn is taken from the sampled pose
/// next in time: it points where the width goes, not where the joint is.
void widen_along_axis(const std::vector<SampledPose>& sampled, int chain_segment, const Vector3d& axis,
                      int joint, double size_m, data::Skeleton& skeleton);

/// A joint that did not move may lie anywhere about its segments: noise only looks like motion.
void widen_all_around(int joint, double size_m, data::Skeleton& skeleton);

}  // namespace kinemark::skeleton::internal
