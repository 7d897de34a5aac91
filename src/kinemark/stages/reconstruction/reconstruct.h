// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/data/trial.h"

namespace kinemark::reconstruction {

/// Options of reconstruct().
struct ReconstructOptions {
  double dim_share = 0.3;  ///< light below this share of the LED's median (each camera's own): not used
  double largest_chi2 =
      40.0;            ///< misfit of two cameras (3 degrees of freedom) above which a point is rejected
  double edge = 0.96;  ///< half-sides; farther out a point is flagged: precision falls to a fifth there
  double flicker_counts = 1.0;    ///< amplitude of the room's flicker, which adds to the noise of each count
  bool light = true;              ///< find the light of each LED, and set offsets by it; else as in the rig
  bool calibration_error = true;  ///< add what the rig's own covariance contributes
  int threads = 0;                ///< 0: all cores. Any number gives the same bits

  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// Counts of one LED's frames by outcome.
struct LedSummary {
  std::string name;               ///< of the LED
  std::int64_t frames = 0;        ///< F
  std::int64_t located = 0;       ///< frames with a point
  std::int64_t occluded = 0;      ///< a camera was dim, dark or lost, so fewer than two were left
  std::int64_t saturated = 0;     ///< a camera stood at its highest code, so fewer than two were left
  std::int64_t inconsistent = 0;  ///< rejected: the cameras contradict each other
  std::int64_t near_edge = 0;     ///< located, but beyond ReconstructOptions::edge
};

/// How an LED's light came to be known.
enum class LightSource : std::uint8_t {
  unknown,    ///< the rig knows neither its cameras' constants nor their dark counts: taken for 1
  direction,  ///< strength in all cameras, the LED keeping its direction
  turning,    ///< strength in all cameras; the LED turns, and its light is what it shows them at most
  stray,      ///< the stray light alone, which contradicts the rig's offsets
};
[[nodiscard]] std::string_view to_string(LightSource source);  ///< "unknown", "direction", "turning", "stray"

/// Light of one LED.
struct LedLight {
  LightSource source = LightSource::unknown;  ///< what `light` stands on
  double light = 1.0;                         ///< relative to the LEDs of the calibration
  double light_sd = 0.0;                      ///< its standard deviation
  double stray = 1.0;                         ///< what its light by way of the room is: sets the offsets
  double stray_sd = 0.0;                      ///< its standard deviation
  std::vector<double> strength_counts;  ///< C, medians of the counts that it makes; 0 where it is not seen
  /// F x C, light as each camera sees it, facing the LED from 1 m: light times the cosine of the LED's
  /// direction. NaN where it is not seen or the rig does not know its cameras' constants.
  Array<double> seen;
};

/// Points of all LEDs, what they stand on, and what became of the rest.
struct Reconstruction {
  /// One marker per LED at the time of its light (sample_offset_s); rejected where inconsistent, missing
  /// elsewhere. Covariance: noise of the counts and, when asked and known, error of the calibration.
  data::Trajectories points;
  Array<std::uint8_t> used;       ///< F x L x C: 1 where the observation served
  Array<std::uint8_t> near_edge;  ///< F x L: 1 where a spot lay beyond the edge
  std::vector<LedSummary> leds;   ///< L
  std::vector<LedLight> lights;   ///< L; empty where they were not asked for
  std::vector<data::Rig> rigs;    ///< L: as the light of each LED shows the rig; one for all without lights
};

/// Points of a recording, frame by frame, from all four currents of every camera.
///
/// Conversions of a frame follow each other: counts are brought to the middle of them by the velocity that
/// the frames beside show, which is the only thing that a frame takes from others.
///
/// An LED that is not as bright as those of the calibration has other offsets: its light is found first,
/// where the rig knows how (find_lights()), and its error is part of the covariance.
///
/// Fails when the recording is of another rig, has other cameras, or no light at all. Cost: about 3 us a
/// point, and 0.1 ms for every 2 cm cell that points lie in when the error of the calibration is added.
/// Theory: docs/theory/reconstruction.md
[[nodiscard]] Result<Reconstruction> reconstruct(const data::Counts& counts, const data::Rig& rig,
                                                 const ReconstructOptions& options = {});

/// Adds to the covariance of points of the same LEDs and frames (of a smoother, say) what the rig's own
/// covariance and the error of each LED's light contribute. As reconstruct() does by itself.
void add_calibration_error(const data::Counts& counts, const Reconstruction& from, data::Trajectories& points,
                           int threads = 0);

/// What the rig's own covariance moves points by, all frames alike, as fields over the room; none where the
/// rig has no covariance. The error of an LED's light is not in it.
/// @param points  F x L, of `from` or of a smoother that began there
/// @param other   F x L, where not null: the same points by a less precise method. What they differ by is one
/// more
///                field, of its own size: how far the method is off, which nobody knows better
/// Cost: 0.1 ms for each of 240 points.
[[nodiscard]] data::CalibrationError calibration_error(const data::Counts& counts, const data::Rig& rig,
                                                       const Reconstruction& from,
                                                       const data::Trajectories& points,
                                                       const data::Trajectories* other = nullptr);

/// The method of 1986: ratios, look-up tables, midpoint of two rays; only dark frames are rejected, and there
/// is no covariance. Fails as above, and when a camera has no table.
[[nodiscard]] Result<Reconstruction> reconstruct_classic(const data::Counts& counts, const data::Rig& rig,
                                                         const ReconstructOptions& options = {});

/// Checks that names, numbers and ids of a recording fit a rig of lateral-effect cameras.
[[nodiscard]] Status check_fit(const data::Counts& counts, const data::Rig& rig);

/// F x L x C: 1 where an observation has enough light, is complete and not saturated. Fails when no LED ever
/// has.
[[nodiscard]] Result<Array<std::uint8_t>> usable_observations(const data::Counts& counts, double dim_share);

}  // namespace kinemark::reconstruction
