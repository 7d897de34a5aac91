// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/stages/skeleton/articulated/recording/recording_pass.h"

namespace kinemark::skeleton::internal {

/// The joints' paths through time.
struct Continuity {
  std::vector<PathPrior> prior;    ///< J; white_jerk 0 where nothing could be smoothed
  std::vector<SmoothedPath> path;  ///< J; empty where the frames do not follow each other
};

/// Smooth the determined frames alone; let that path choose among the places that fit a flagged frame, or
/// fill in what the frame leaves open; smooth again. Chosen frames gain information in `pass.points`.
///
/// A place is chosen when it leads the others by a factor of 100 and lies within five standard deviations of
/// the path. Else the frame is solved once more with the path as knowledge about its joints; what it then
/// adds is used when its cost is explained by noise and the joint stays within five standard deviations.
/// O(F).
[[nodiscard]] Continuity follow_paths(const ChainFit& fit, const ChainSamples& samples, double rate_hz,
                                      int threads, RecordingPass& pass);

}  // namespace kinemark::skeleton::internal
