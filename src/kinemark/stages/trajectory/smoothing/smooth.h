// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Smooth positions and differentiate them, with a standard deviation for every number.
// Derivation, sources and what the bars mean: docs/theory/smoothing.md
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/derivatives.h"
#include "kinemark/data/marker_account.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/smoothing/smooth_options.h"

namespace kinemark::trajectory {

/// Smoothed trajectories, their rates, and the account of each marker.
struct SmoothResult {
  data::Trajectories trajectories;  ///< as the input, smoothed, with covariance when the noise is known
  data::Derivatives derivatives;    ///< velocity, acceleration, jerk
  std::vector<data::MarkerAccount> markers;  ///< M
};

/// Smooth every marker and find velocity, acceleration and jerk.
///
/// What is missing stays missing, unless `max_bridge_s` asks for more; bridged samples become `interpolated`,
/// made by "kalman" or "gcv". Butterworth, savgol and classic treat the stretches between gaps as separate
/// recordings. Samples are smoothed at their own times (`sample_offset_s`), which the result keeps. Samples
/// that an earlier stage made count as one observation for each stretch, and keep at least the standard
/// deviation that it gave them: a fill errs for the whole gap in one way. The result tells its filters and
/// keeps the samples that went in (hand_on()). Numbers that cannot be had (velocity
/// of a single sample) are NaN; no gap spreads to its neighbours.
///
/// Fails with bad_input when the trajectories do not validate() or a marker's times do not rise, with usage
/// when options do not check(), with cancelled when `progress` says so. O(F M); the result holds about 31
/// numbers for each marker and frame: for recordings of hours see smooth_each().
[[nodiscard]] Result<SmoothResult> smooth(const data::Trajectories& in, const SmoothOptions& options = {});

/// One marker's part of the result. F frames, in the order of data::Trajectories.
struct MarkerResult {
  std::int64_t marker = 0;   ///< index in the recording
  Array<double> x;           ///< F x 3, m
  Array<double> covariance;  ///< F x 6, m^2; empty when the noise is unknown
  Array<double> velocity, velocity_sd, acceleration, acceleration_sd, jerk, jerk_sd;  ///< F x 3; SDs as above
  Array<data::SampleState> state;                                                     ///< F
  data::MarkerAccount account;  ///< what was done and why
};

/// The same, marker by marker: `sink` is given each result, in the order of the markers, from the calling
/// thread, and no more than `threads` of them exist at a time. A failure of the sink ends the work and is
/// returned.
[[nodiscard]] Status smooth_each(const data::Trajectories& in, const SmoothOptions& options,
                                 const std::function<Status(MarkerResult&&)>& sink);

}  // namespace kinemark::trajectory
