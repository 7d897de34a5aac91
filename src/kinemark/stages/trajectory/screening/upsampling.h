// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Detects recordings that were interpolated from a lower rate: factor, phase and kernel of each stream.
// Derivation, rates of error and limits: docs/theory/upsampling.md
#pragma once

#include <cstdint>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/data/upsampling.h"

namespace kinemark::trajectory {

/// Options of detect_upsampling().
struct UpsamplingOptions {
  int max_factor = 6;                  ///< 2 to 12
  std::int64_t max_frames = 20'000;    ///< of each stream used for the verdict, in evenly spaced pieces;
                                       ///< phases are then followed through all frames; >= 1000
  [[nodiscard]] Status check() const;  ///< Ranges hold.
};

/// Test each marker and the whole recording for interpolation from a lower rate.
///
/// For each factor, phase and kernel the samples between supposed real ones are predicted; the true phase
/// leaves rounding only, the others leave noise. As phases are compared with one another, smooth, filtered,
/// still or rounded data do not look interpolated. Only samples that are present, in stretches of 12 factor
/// frames and more take part (24 factor for splines). Tolerates: gaps, rounding, real instants that wander by
/// about 0.3 frames, a phase that slips now and then (a clock that drifts, a dropped frame), noise added
/// later below a tenth of that of the samples.
///
/// Cannot detect interpolation followed by a low-pass filter, to band-limited resampling, to factors that are
/// no integer, and to streams without noise above their rounding; `band` tells the first two from open data.
/// Fails when the trajectories are invalid or the options do not hold. O(frames markers max_factor^2).
[[nodiscard]] Result<data::UpsamplingAccount> detect_upsampling(const data::Trajectories& trajectories,
                                                                const UpsamplingOptions& options = {});

}  // namespace kinemark::trajectory
