// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint centres on simulated limbs against truth and bound: one tally for a cell of noise, missing and shape.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/data/skeleton.h"
#include "kinemark/stages/simulation/limb.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"

namespace kinemark::joint_cells {

/// Sums over the joint frames of several recordings.
struct Tally {
  /// Of frames called determined, whose bound exists; where the fit claims less than half the bound's
  /// variance (near a fold), its claim instead of the bound.
  double squares_m2 = 0.0, bound_m2 = 0.0;
  std::vector<double> seed_ratio;                          ///< one a recording
  std::int64_t frames = 0, determined = 0;                 ///< joint frames, all and called determined
  std::int64_t bounded = 0, determined_without_bound = 0;  ///< of the latter: with a bound, and without
  std::int64_t whole = 0, whole_flagged = 0;    ///< a neighbouring segment fully seen; not called determined
  std::int64_t wrong = 0, wrong_unflagged = 0;  ///< errors beyond 5 SD, and those called determined
  std::int64_t coordinates = 0, in_1sd = 0, in_2sd = 0;  ///< of frames called determined
  std::int64_t lengths = 0, length_in_1sd = 0, length_in_2sd = 0;
  std::int64_t pairs = 0, pairs_flagged = 0;  ///< two markers and one: a mirror pair
  double noise_ratio = 0.0;                   ///< found over true, sum over recordings
  int kinds[3] = {0, 0, 0};                   ///< segments taken for line, plane, solid
  double smooth_squares_m2 = 0.0;             ///< with continuity: frames determined on their own
  double bridged_squares_m2 = 0.0;            ///< the others that are answered
  std::int64_t bridged = 0, unanswered = 0;
  double worst_m = 0.0;

  [[nodiscard]] double ratio() const;
  [[nodiscard]] double worst_seed() const;
  [[nodiscard]] double rms_mm() const;
  [[nodiscard]] double bound_mm() const;
  [[nodiscard]] double share() const { return part(determined, frames); }
  [[nodiscard]] static double part(std::int64_t n, std::int64_t of) {
    return of > 0 ? static_cast<double>(n) / static_cast<double>(of) : 1.0;
  }
  void add(const Tally& other);
  /// RMS and bound are those of the frames that are determined and have a bound:
  /// "ratio 1.003 (worst seed 1.05), RMS 2.75 mm, bound 2.74 mm, determined 98.8 %, ..."
  [[nodiscard]] std::string description() const;
};

/// Fit one recording and add it. The bound is that of `kind` for all segments.
void measure(const simulation::LimbRecording& limb, data::SegmentKind kind, double noise_sd_m,
             const skeleton::ArticulatedOptions& options, Tally& tally);

/// A cell of simulate_chain(): seeds 1 to `seeds`.
[[nodiscard]] Tally run_cell(simulation::ChainOptions chain, data::SegmentKind kind, int seeds,
                             const skeleton::ArticulatedOptions& options);

}  // namespace kinemark::joint_cells
