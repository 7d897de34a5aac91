// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/stages/skeleton/articulated/recording/recording_pass.h"

namespace kinemark::skeleton::articulated {

/// The joints' paths through time.
struct Continuity {
  std::vector<PathPrior> prior;    ///< J; white_jerk 0 where nothing could be smoothed
  std::vector<SmoothedPath> path;  ///< J; empty where the frames are few or do not follow each other
};

constexpr std::int64_t kLeastFollowed = 10;  ///< frames that determine a joint, for a path of it

/// Smooth the determined frames alone; let that path choose among the positions that fit a flagged
/// frame, or fill in what the frame leaves open; smooth again. Chosen frames gain information in
/// `pass.points`. A position is chosen when it is 100 times as likely as the others and lies within five
/// standard deviations of the path. Otherwise the frame is solved once more with the path as prior of its
/// joints; the result is used when noise explains its cost and the joint stays within five standard
/// deviations of the path. O(F).
[[nodiscard]] Continuity follow_paths(const FittedChain& fit, const ChainSamples& samples, double rate_hz,
                                      int threads, RecordingPass& pass);

}  // namespace kinemark::skeleton::articulated
