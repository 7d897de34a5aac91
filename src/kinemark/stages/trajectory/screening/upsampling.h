// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Detects recordings that were interpolated from a lower rate: factor, phase and kernel of each stream.
// Derivation, rates of error and limits: docs/theory/upsampling.md
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/screening/band_check.h"

namespace kinemark::trajectory {

/// How the samples between two real ones were made.
enum class Kernel : std::uint8_t { none, hold, linear, spline, catmull_rom, lagrange, pchip, akima };

/// "none", "hold", "linear", "cubic spline", "Catmull-Rom", "Lagrange", "PCHIP", "Akima".
[[nodiscard]] std::string_view to_string(Kernel kernel);

/// From this frame to the next run real samples are the frames n with n % factor == phase.
struct PhaseRun {
  std::int64_t first_frame = 0;
  int phase = 0;
};

/// One stream, or all streams together. Factor 1: not found to be interpolated; the numbers then are those of
/// the candidate that came closest.
struct Upsampling {
  int factor = 1;                ///< 1, or 2 to UpsamplingOptions::max_factor
  int phase = 0;                 ///< where most real samples lie: frame % factor
  Kernel kernel = Kernel::none;  ///< Lagrange and Catmull-Rom are one formula at factor 2
  double ratio = 1.0;            ///< residual of this phase over the best other one, median over blocks
  double agreement = 0.0;        ///< share of informative blocks that this phase wins
  std::int64_t blocks = 0;       ///< informative ones: the noise there stands above the rounding
  double residual_m = 0.0;       ///< what the kernel leaves unexplained, median RMS
  double rounding_m = 0.0;       ///< the same if there is nothing but rounding
  std::vector<PhaseRun> runs;    ///< in time order, the first at frame 0; more than one where the phase slips
  bool inherited = false;        ///< too few data of its own (at rest, short): copied from the recording

  [[nodiscard]] bool found() const { return factor > 1; }
  /// Phase in force at a frame; 0 when nothing was found.
  [[nodiscard]] int phase_at(std::int64_t frame) const;
  /// True when the sample was measured, or nothing was found.
  [[nodiscard]] bool real(std::int64_t frame) const {
    return factor == 1 || frame % factor == phase_at(frame);
  }
};

/// Options of detect_upsampling().
struct UpsamplingOptions {
  int max_factor = 6;                ///< 2 to 12
  std::int64_t max_frames = 20'000;  ///< of each stream used for the verdict, in evenly spaced pieces;
                                     ///< phases are then followed through all frames; >= 1000
  [[nodiscard]] Status check() const;
};

/// Result of the test, with its limits.
struct UpsamplingReport {
  Upsampling recording;                 ///< all markers pooled
  std::vector<Upsampling> markers;      ///< M
  BandCheck band;                       ///< median over the markers
  std::vector<BandCheck> marker_bands;  ///< M
  std::vector<std::string> sentences;   ///< for people; the last one names what the test cannot detect
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
[[nodiscard]] Result<UpsamplingReport> detect_upsampling(const data::Trajectories& trajectories,
                                                         const UpsamplingOptions& options = {});

}  // namespace kinemark::trajectory
