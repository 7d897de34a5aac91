// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The bias of maximum likelihood where noise hides most of a segment's rotation, found by fitting data that
// the fitted limb itself made.
#pragma once

#include <cstddef>

#include "kinemark/stages/skeleton/articulated/chain/fitted_chain.h"
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"

namespace kinemark::skeleton::articulated {

// What tells a joint of a body from one that is none, before a geometry is refined.

/// Distance of a joint from the nearest marker of the segment that it is farther from, m; infinite where it
/// is no number.
[[nodiscard]] double reach_of(const Chain& chain, int joint);

/// RMS change over `frames` of the distance between a joint and that marker of its two segments that keeps it
/// least, m. Markers that are seen in fewer than two of them do not count; infinite where it is no number.
[[nodiscard]] double distance_change(const Chain& chain, const ChainSamples& samples,
                                     const PosedFrames& frames, int joint);

/// A segment that is no line is weak when its markers' second extent is within some times the noise: each
/// frame then rotates it about its long axis to fit its own noise, which makes the shape too wide, the
/// residuals too small and the centres' errors larger than their covariance, however many frames there are.
[[nodiscard]] bool has_weak_rotation(const Chain& chain, double sigma_m);

struct Bootstrap {
  Eigen::VectorXd bias;         ///< of the geometry parameters, m
  double chi2_ratio = 1.0;      ///< residuals' chi-square over its degrees of freedom
  double variance_ratio = 1.0;  ///< squared error of determined centres over their variance, geometry held
};

/// Frames of a replicate, at most: the bias is a frame's own, and more frames do not change it.
inline constexpr std::size_t kBootstrapFrames = 400;

/// Parametric bootstrap: `replicates` recordings of the fitted chain in its fitted poses, same markers seen,
/// noise of the fitted size; each fitted anew from its own starts.
[[nodiscard]] Bootstrap bootstrap(const ChainSamples& samples, const PosedFrames& frames,
                                  const FittedChain& fit, int replicates);

}  // namespace kinemark::skeleton::articulated
