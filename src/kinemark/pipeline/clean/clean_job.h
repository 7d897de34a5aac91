// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Clean trajectories: what the recorder spoiled or made is found, gaps are filled, noise is smoothed, and
// every sample says what happened to it.
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/stages/report/clean_report.h"
#include "kinemark/stages/trajectory/gaps/gap_options.h"
#include "kinemark/stages/trajectory/smoothing/smooth_options.h"
#include "kinemark/workflow/prepare/marker_screening.h"

namespace kinemark::pipeline {

/// What `kinemark clean` is asked to do. Paths that are empty are not used. Doubtful samples are kept unless
/// they are to be dropped: they become `rejected` then, and so gaps.
struct CleanJob : JobSettings, RecordingOptions {
  std::filesystem::path input;   ///< .c3d, .trc, .csv or .nwb
  std::filesystem::path output;  ///< likewise; OUT_report.json goes beside it
  std::filesystem::path report;  ///< page to write as well
  workflow::RecorderMade recorder_made =
      workflow::RecorderMade::mark;  ///< what is done with samples that the recorder made
  bool exchange_back = true;  ///< markers that surely carry each other's label get their own; else only told
  trajectory::GapOptions gaps{.method = trajectory::GapMethod::none};  ///< how gaps are filled
  trajectory::SmoothOptions filter;                                    ///< how positions are smoothed
  bool keep_unfiltered = true;  ///< samples as they were before the filter are written beside the smoothed
                                ///< ones, where the format can keep them
  bool derivatives = false;     ///< velocity, acceleration and jerk with their SDs: into an .nwb, else
                                ///< OUT_derivatives.sto
};

/// Warnings: what the output format cannot hold.
struct CleanOutcome : JobOutcome {
  data::Trial trial;           ///< as written, without what is only in an .nwb (covariance, derivatives)
  report::CleanReport report;  ///< what the page shows
};

/// Read, screen, mark what the recorder made, fill, smooth, write. Either all files appear or, on a failure,
/// none. Screening and the search for upsampling only tell unless the job says otherwise, but for labels that
/// were exchanged, which go back; gaps are filled only with a gap method. A recording that was smoothed
/// before and keeps the samples from before is smoothed from those; one that does not is smoothed once more,
/// and a warning says so. Progress counts markers.
[[nodiscard]] Result<CleanOutcome> run_clean(const CleanJob& job);

}  // namespace kinemark::pipeline
