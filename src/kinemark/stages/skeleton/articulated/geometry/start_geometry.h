// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A first geometry without any pose: shapes from distances between markers, joints by SCoRE.
#pragma once

#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stages/skeleton/articulated/chain/chain.h"

namespace kinemark::skeleton::articulated {

/// Shapes put together at their joints: o_a + R_a p_a = o_b + R_b p_b over all frames that show both
/// segments, by weighted least squares (SCoRE, Ehrig et al. 2006, J Biomech 39:2798; a line offers its
/// direction only). A last segment of one or two markers takes the joint from a sphere about it.
[[nodiscard]] Result<Chain> start_geometry(const ChainSamples& samples, const ChainLayout& layout,
                                           const std::vector<data::SegmentKind>& kind, double sigma_m);

}  // namespace kinemark::skeleton::articulated
