// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "kinemark/pipeline/motion/motion_job.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/motion/scaling/adapt.h"

namespace kinemark::pipeline {

/// What `kinemark track` is asked to do. Writes Q.mot, Q_sd.sto, Q_bound.sto, Q_tau.sto, Q_tau_sd.sto,
/// Q_rank.sto, Q_marker_errors.sto, Q_report.json and, with several levels, Q_levels.sto; where the body is
/// adapted Q_model.osim.
struct TrackJob : MotionJob {
  motion::TrackOptions options;  ///< of the tracking
  std::filesystem::path report;  ///< page to write as well, .html
  bool adapt = false;  ///< sizes of segments and positions of markers are adapted to the recording first
};

/// What `kinemark track` did.
struct TrackOutcome : MotionOutcome {
  motion::TrackResult result;                  ///< motion and fit
  std::optional<motion::AdaptResult> adapted;  ///< sizes that were found, where they were asked for
};

/// How far a task was from its goal: "0.12 deg RMS from its goal, 0.5 deg at most".
[[nodiscard]] std::string describe_task(const motion::TaskAccount& task);

/// The options that give the same levels: "--level A,B --level '*'".
[[nodiscard]] std::string describe_proposal(const motion::LevelProposal& proposal);

/// Read, track, judge and write. Either all files appear or, on a failure, none. Threads and seed of the
/// options are the job's. Progress counts frames.
[[nodiscard]] Result<TrackOutcome> run_track(TrackJob job);

}  // namespace kinemark::pipeline
