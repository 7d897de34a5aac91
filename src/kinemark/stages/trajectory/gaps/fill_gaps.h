// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Fill gaps from the marker's own path, from neighbouring markers and from both, with a standard deviation
// for every sample. Derivation, sources and what the bars mean: docs/theory/gaps.md
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/finding.h"
#include "kinemark/data/gap_account.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/gaps/gap_options.h"

namespace kinemark::trajectory {

/// A recording with its gaps filled, and the account of each.
struct GapResult {
  data::Trajectories trajectories;     ///< as the input; samples present there are untouched
  std::vector<data::GapAccount> gaps;  ///< by marker and frame; every gap has its account
  /// Label swaps that the label check found, of markers of a rigid group that sit in each other's place for a
  /// while. Nothing is relabelled.
  std::vector<data::Finding> swaps;

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
