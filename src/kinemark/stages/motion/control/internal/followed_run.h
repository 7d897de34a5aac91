// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A body that follows a whole recording, and what its samples are then judged to be.
#pragma once

#include <expected>

#include "kinemark/core/progress.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/control/internal/recorder.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/motion/internal/judged_frames.h"

namespace kinemark::motion::internal {

/// The samples of all frames of the plan, and the end of them.
void fill_window(const Plan& plan, const data::Trajectories& markers, SampleWindow& samples);

/// What a caller gets that stopped a run.
[[nodiscard]] std::unexpected<Error> stopped();

/// Samples as they are followed.
struct Followed {
  const data::Trajectories& kept;   ///< of what the deviations are
  const data::Trajectories& goals;  ///< the same, and in place of what was left out where the body has it
};

/// A body that has followed a recording.
struct FollowedRun {
  Plan plan;
  Track track;
  TrackResult result;
};

/// A body that has followed the samples, and how they were judged.
struct JudgedRun {
  FollowedRun body;
  JudgedFrames judged;
  [[nodiscard]] const data::Trajectories& kept(const data::Trajectories& markers) const {
    return judged.kept ? *judged.kept : markers;
  }
  /// What was left out is followed where its marker lies on the body in the frames beside, lest the goals
  /// jump.
  [[nodiscard]] const data::Trajectories& goals(const data::Trajectories& markers,
                                                const TrackOptions& options) const {
    return judged.filled && options.derivatives == nullptr ? *judged.filled : kept(markers);
  }
};

/// Run the body of `run.plan` through the recording.
[[nodiscard]] Status follow(const data::Trajectories& markers, const Followed& followed,
                            const GoalFilter& filter, const TrackOptions& options, const Progress& progress,
                            FollowedRun& run);

/// Follow all samples as they are; where that does not explain each of them, judge them and follow what is
/// left.
[[nodiscard]] Result<JudgedRun> first_run(const Plan& plan, const data::Trajectories& markers,
                                          const GoalFilter& filter, const TrackOptions& options,
                                          const Progress& progress);

}  // namespace kinemark::motion::internal
