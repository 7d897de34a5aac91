// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/progress.h"
#include "kinemark/pipeline/motion/motion_job.h"
#include "kinemark/stages/motion/control/track.h"

namespace kinemark::pipeline {

/// What `kinemark track` is asked to do. Writes Q.mot, Q_sd.sto, Q_bound.sto, Q_tau.sto, Q_tau_sd.sto,
/// Q_rank.sto, Q_marker_errors.sto and Q_report.json.
struct TrackJob : MotionJob {
  motion::TrackOptions options;  ///< of the tracking
};

/// What `kinemark track` did.
struct TrackOutcome : MotionOutcome {
  motion::TrackResult result;  ///< motion and fit
};

/// Read, track, check and write. Either all files appear or, on a failure, none.
[[nodiscard]] Result<TrackOutcome> run_track(const TrackJob& job, const Progress& progress = {});

}  // namespace kinemark::pipeline
