// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Clean trajectories: what the recorder spoiled or made is found, gaps are filled, noise is smoothed, and
// every sample says what happened to it.
#pragma once

#include <cstdint>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/data/clean_account.h"
#include "kinemark/data/derivatives.h"
#include "kinemark/data/recording.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/gaps/gap_options.h"
#include "kinemark/stages/trajectory/smoothing/smooth_options.h"
#include "kinemark/workflow/prepare/marker_screening.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow {

/// What is done about samples that are wrong or missing.
struct RepairOptions {
  RecorderMade recorder_made = RecorderMade::mark;  ///< what becomes of samples that the recorder made
  bool exchange_back = true;  ///< markers that surely carry each other's label get their own; else only said
  bool reject_doubtful = false;  ///< sure defects become `rejected`, and so gaps
  trajectory::GapOptions gaps{.method = trajectory::GapMethod::none};  ///< how gaps are filled
  std::uint64_t seed = 1;                                              ///< of fills
  int threads = 1;  ///< 0: all cores. Any number gives the same bits.
};

/// A recording whose samples are repaired, and not yet smoothed.
struct Repaired {
  data::Recording recording;        ///< screened and filled
  data::Trajectories before;        ///< its markers before gaps were filled
  PointsApart apart = {};           ///< points that are no markers: they stay as they are
  data::CleanAccount account = {};  ///< of the recorder, of defects, of gaps
  Remarks remarks;                  ///< what had to go with frames that went
};

/// Find what the recorder did, do about it what the options say, and fill gaps. Points that are no markers
/// (find_points_apart()) stay as they are, and nothing is learned from them. Fails as screen_markers() and
/// trajectory::fill_gaps().
[[nodiscard]] Result<Repaired> repair(data::Recording recording, const RepairOptions& options = {});

/// Markers that were smoothed before go back to the samples that went in then, where these are kept. What
/// there is to say of the filters; empty where nothing was smoothed.
/// @param smooths  whether the markers are smoothed anew: else they stay as they are
[[nodiscard]] std::string begin_unfiltered(data::Trajectories& markers, bool smooths);

/// What is asked of clean().
struct CleanOptions {
  RepairOptions repair = {};              ///< before smoothing
  trajectory::SmoothOptions filter = {};  ///< how positions are smoothed; its threads are those of smoothing
};

/// A cleaned recording with its rates.
struct Cleaned {
  data::Recording recording;        ///< smoothed, with covariance where the noise is known
  data::Derivatives derivatives;    ///< velocity, acceleration, jerk with their SDs
  data::CleanAccount account = {};  ///< what was done to each marker, and why
  Remarks remarks;                  ///< filters of before, what had to go
};

/// Repair a recording, then smooth it: all in memory, about 31 numbers for each marker and frame (`kinemark
/// clean` goes marker by marker). A recording that was smoothed before and keeps the samples from before is
/// smoothed from those. Fails as repair() and trajectory::smooth().
[[nodiscard]] Result<Cleaned> clean(data::Recording recording, const CleanOptions& options = {});

}  // namespace kinemark::workflow
