// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Clean trajectories: what the recorder spoiled or made is found, gaps are filled, noise is smoothed, and
// every sample says what happened to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/report/clean_report.h"
#include "kinemark/stages/trajectory/gaps/gap_options.h"
#include "kinemark/stages/trajectory/smoothing/smooth_options.h"

namespace kinemark::pipeline {

/// What becomes of samples that the recorder interpolated.
enum class RecorderMade : std::uint8_t {
  keep,      ///< told, not touched
  mark,      ///< their state becomes `upsampled`
  missing,   ///< only real samples stay
  decimate,  ///< real samples at the rate at which they were taken
};

[[nodiscard]] std::string_view to_string(RecorderMade made);  ///< "keep", "mark", "missing", "decimate"
/// The choice of that name; the failure lists all names.
[[nodiscard]] Result<RecorderMade> parse_recorder_made(std::string_view name);

/// What `kinemark clean` is asked to do. Paths that are empty are not used.
struct CleanJob {
  std::filesystem::path input;                      ///< .c3d, .trc, .csv or .nwb
  std::filesystem::path output;                     ///< likewise; OUT_report.json goes beside it
  std::filesystem::path report;                     ///< page to write as well
  RecorderMade recorder_made = RecorderMade::mark;  ///< what is done with samples that the recorder made
  bool reject_defects = false;  ///< spikes, swaps, stuck and false samples become `rejected`, then gaps
  trajectory::GapOptions gaps{.method = trajectory::GapMethod::none};  ///< how gaps are filled
  trajectory::SmoothOptions filter;                                    ///< how positions are smoothed
  bool derivatives = false;  ///< velocity, acceleration and jerk with their SDs: into an .nwb, else
                             ///< OUT_derivatives.sto
  int threads = 1;           ///< 0: all cores. Any number gives the same bits.
  std::uint64_t seed = 1;    ///< of artificial gaps
  bool force = false;        ///< replace files that exist
  std::string command_line;  ///< for the record
};

/// What `kinemark clean` did.
struct CleanOutcome {
  data::Trial trial;               ///< as written, without what is only in an .nwb (covariance, derivatives)
  report::CleanReport report;      ///< what the page shows
  std::vector<std::string> notes;  ///< what the output format cannot hold, one sentence each
  std::vector<std::filesystem::path> written;  ///< all files, in order
};

/// Read, screen, mark what the recorder made, fill, smooth, write. Either all files appear or, on a failure,
/// none. Screening and the search for upsampling only tell unless the job says otherwise; gaps are filled
/// only with a gap method. `progress` counts markers.
[[nodiscard]] Result<CleanOutcome> run_clean(const CleanJob& job, const Progress& progress = {});

}  // namespace kinemark::pipeline
