// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Paths directly from counts: every conversion is used at its own time.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/derivatives.h"
#include "kinemark/data/rig.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::trajectory {

/// Light of the room that flickers with the mains.
enum class Flicker {
  regress,    ///< cosine and sine found in the residuals of each LED and camera
  dark_slot,  ///< found in the slot without LED; regress where there is none
  ignore,
};

/// Options of smooth_counts().
struct SmoothCountsOptions {
  int order = 0;                       ///< 3, 4 or 5 integrations; 0: chosen for each LED by SURE
  double half_gain_hz = 0.0;           ///< of the filter; 0: chosen for each LED by SURE
  Flicker flicker = Flicker::regress;  ///< what is done about the room's lamps
  double flicker_hz = 120.0;           ///< of the lamps' light
  double dim_share =
      0.3;  ///< light below this share of the LED's median (each camera's own) is no observation
  double student_freedom = 6.0;  ///< of the weights on each camera's misfit
  double reject_chi2 = 40.0;     ///< misfit of one camera (3 degrees of freedom) from which it is not used
  double longest_gap_s = 0.3;    ///< longer ones stay missing, and the path is cut there
  double largest_sd_m = 0.02;    ///< samples less certain than this on some axis stay missing
  int passes = 5;                ///< 3 or more
  int threads = 0;               ///< LEDs are smoothed beside each other

  [[nodiscard]] Status check() const;  ///< Ranges hold and no number is NaN.
};

/// A smoother of the family "order-times integrated Wiener process".
struct Bandwidth {
  int order = 4;                  ///< 3, 4 or 5
  double spectral_density = 0.0;  ///< q of the order-th derivative, m^2 s^(1 - 2 order)
  double time_constant_s = 0.0;   ///< 1 / omega0
  double cutoff_hz = 0.0;         ///< -3 dB of the whole smoother
  double sure = 0.0;              ///< risk found, less a constant
};

/// Parameters and statistics of one LED's path.
struct LedFit {
  std::string name;           ///< of the LED
  Bandwidth bandwidth;        ///< of its filter
  double chi2_per_dof = 0.0;  ///< of the observations used, robust weights left out; near 1 when noise is all
  std::int64_t observations = 0;       ///< used, of F x C
  std::int64_t rejected = 0;           ///< misfit above reject_chi2
  std::int64_t held_down = 0;          ///< weight below one half
  std::vector<double> flicker_counts;  ///< amplitude found, per camera
};

/// Paths of all LEDs, with their rates.
struct SmoothedCounts {
  /// One marker per LED, at the times of the frames. Frames with an observation are measured, frames between
  /// observations model_filled (with their covariance), frames before the first and after the last one
  /// missing. Measured ones tell that they were smoothed; with them go the filter of each LED, the noise that
  /// `start` had against it, and the points of `start` from before the filter (hand_on_start()).
  data::Trajectories points;
  data::Derivatives derivatives;  ///< velocity and acceleration
  std::vector<LedFit> leds;       ///< L
};

/// Smooth the paths of all LEDs of a recording.
///
/// Maximum a posteriori of an integrated Wiener process whose position, at the time of each conversion less
/// the amplifier's delay, makes the counts. Source strength is eliminated for each camera and frame.
/// Student-t weights on each camera's misfit, flicker of the room, order and bandwidth by Stein's unbiased
/// risk.
///
/// @param start  F x L points to begin from (reconstruct()), right to a centimetre or so; missing ones are
/// bridged
/// @param rigs   one for all LEDs, or one each, as its light shows it (camera::with_light())
/// Fails when shapes disagree. An LED without two complete observations stays missing. Cost: about 50
/// us per frame and LED. Theory: docs/theory/reconstruction.md
[[nodiscard]] Result<SmoothedCounts> smooth_counts(const data::Counts& counts,
                                                   std::span<const data::Rig> rigs,
                                                   const data::Trajectories& start,
                                                   const SmoothCountsOptions& options = {});
/// The same with one rig for all LEDs.
[[nodiscard]] inline Result<SmoothedCounts> smooth_counts(const data::Counts& counts, const data::Rig& rig,
                                                          const data::Trajectories& start,
                                                          const SmoothCountsOptions& options = {}) {
  return smooth_counts(counts, std::span(&rig, 1), start, options);
}

}  // namespace kinemark::trajectory
