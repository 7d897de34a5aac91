// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Geometries that differ by the side of its markers on which a joint lies, and fit nearly alike.
#pragma once

#include "kinemark/stages/skeleton/articulated/chain/fitted_chain.h"
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"

namespace kinemark::skeleton::articulated {

/// Refits from geometries whose joints are reflected at the plane of their segment's markers, joint by joint.
/// A better one replaces `fit.chain` (returns true); fit.mirror_margin becomes the chi-square between it and
/// the next best.
bool try_mirrored(const ChainSamples& samples, const PosedFrames& frames, FittedChain& fit, int threads = 1);

}  // namespace kinemark::skeleton::articulated
