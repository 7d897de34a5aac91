// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Fill gaps from the marker's own path, from neighbouring markers and from both, with a standard deviation
// for every sample. Derivation, sources and what the bars mean: docs/theory/gaps.md
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/gaps/gap_options.h"

namespace kinemark::trajectory {

/// Error of one candidate on the artificial gaps, and its weight in the fill.
struct CandidateWeight {
  std::string name;      ///< "cubic", "walk", "regression, tied", ...
  double weight = 0.0;   ///< >= 0; all weights of a gap sum to 1
  double rms_m = 0.0;    ///< 3D distance, RMS over the artificial gaps; NaN when there were none
  bool guarded = false;  ///< left out: deviates from all others by more than its own errors allow
};

/// One gap of one marker, filled or not. A gap whose predictors change on the way is one account per piece.
struct GapAccount {
  std::int64_t marker = 0;
  std::int64_t first_frame = 0;  ///< both ends belong to the gap
  std::int64_t last_frame = 0;
  bool at_edge = false;  ///< touches the start or the end of the recording
  bool filled = false;
  bool temporal = false;  ///< filled from the marker's own path alone
  std::string method;     ///< as in Trajectories::methods, "auto" for a combination; "" when left open
  std::vector<CandidateWeight> candidates;  ///< largest weight first
  double sd_m = 0.0;                        ///< predicted, per axis, RMS over the gap; NaN when unknown
  double max_sd_m = 0.0;                    ///< the largest along the gap and over the axes; NaN when unknown
  int windows = 0;                          ///< artificial gaps that weights and SD come from
  double window_s = 0.0;                    ///< their length; shorter than the gap in short recordings
  std::vector<std::string> predictors;      ///< markers that the fill is predicted from, most rigid first
  std::vector<std::string> dropped;         ///< markers left out: not where they usually are in the gap
  std::string why_open;                     ///< a sentence when the gap was left open, else ""

  [[nodiscard]] std::int64_t frames() const { return last_frame - first_frame + 1; }
};

/// Two markers of a rigid group whose labels are exchanged in a stretch of frames.
struct SwapFinding {
  std::int64_t first_marker = 0;
  std::int64_t second_marker = 0;
  std::int64_t first_frame = 0;  ///< both ends belong to it
  std::int64_t last_frame = 0;
  double distance_m = 0.0;  ///< median error of position
  std::string sentence;
};

struct GapResult {
  data::Trajectories trajectories;  ///< as the input; samples present there are untouched
  std::vector<GapAccount> gaps;     ///< by marker and frame; every gap has its account
  std::vector<SwapFinding> swaps;   ///< found by the label check; nothing is relabelled

  [[nodiscard]] std::int64_t filled_frames() const;  ///< sum over the markers
};

/// Fill what is missing, if that can be done within the bounds of the options.
///
/// A filled sample has a state (`interpolated` when it came from the marker's own path alone, else
/// `model_filled`), a method ("cubic", ..., "auto") and a covariance. Its covariance is that of the method's
/// errors on artificial gaps of the same length in the same recording, scaled by how far the candidates
/// disagree here, plus the noise of a sample. Where the input has no covariance, that of present samples is
/// set to noise_sd_m squared, estimated when it is 0. Rejected samples count as missing. Samples that are
/// present but neither `measured` nor `upsampled` (filled earlier) are neither changed nor learned from.
///
/// A gap stays missing, with the reason in its account, when it is longer than max_gap_s, touches the start
/// or end of the recording and there is nothing but time to predict from for more than max_extrapolation_s,
/// has no sample on a side, or its SD is larger than max_sd_m or unknown. Gaps where the set of complete
/// neighbours changes are filled in pieces that are tied to one another. Filled samples are never used to
/// fill others.
///
/// Fails with bad_input when the trajectories do not validate(), with usage when options do not check(), with
/// cancelled when `progress` says so. About 10 ms per gap with `automatic`, less for single methods.
[[nodiscard]] Result<GapResult> fill_gaps(const data::Trajectories& in, const GapOptions& options = {});

}  // namespace kinemark::trajectory
