// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/report/ik_summary.h"

namespace kinemark::pipeline {

/// What `kinemark track` is asked to do.
struct TrackJob {
  std::filesystem::path model, markers;
  std::filesystem::path output;  ///< Q.mot; Q_sd.sto, Q_bound.sto, Q_tau.sto, Q_marker_errors.sto and
                                 ///< Q_report.json go beside it
  double rate_hz = 0.0;          ///< of a marker file that tells none (.v3d); 0: not given
  motion::TrackOptions options;
  double max_rms_m = 0.05;     ///< quality gate: RMS distance of measured and model markers
  double max_offset_m = 0.05;  ///< quality gate: length of the mean distance vector
  bool force = false;
  std::string command_line;  ///< for the record
};

struct TrackOutcome {
  motion::TrackResult result;
  report::IkSummary summary;  ///< gates and findings included
  std::vector<std::filesystem::path> written;
  int exit_status = 0;  ///< 0, or 1 when a gate failed
};

/// Read, track, check and write. Either all files appear or, on a failure, none.
[[nodiscard]] Result<TrackOutcome> run_track(const TrackJob& job, const Progress& progress = {});

}  // namespace kinemark::pipeline
