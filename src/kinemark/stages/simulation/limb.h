// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Limbs made of straight segments with markers on them: the arm of Kirk et al. (2005) as the macaque report
// simulated it, and chains of any length. For studying joint centres.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::simulation {

/// A recording of a limb, and the truth.
struct LimbRecording {
  data::Trajectories markers;     ///< with noise and what is missing
  data::SegmentLayout layout;     ///< segments root first; joint j joins segments j and j + 1
  Array<double> x_true;           ///< F x M x 3, m: all markers, without noise
  Array<double> centre_in_world;  ///< F x J x 3, m: the joints between the segments
  Array<double> end_in_world;     ///< F x 3, m: the far end of the last segment
  /// Names of the chain's origin, which stays at (0, 0, 0), and of its far end; empty where they have none.
  std::string origin_name, end_name;
  /// S matrices 3 x (markers of the segment), m: their positions in segment axes, z along the bone from its
  /// upper joint.
  std::vector<Eigen::Matrix3Xd> x_in_segment;
};

/// Options of simulate_chain(): every frame is a pose of its own, each segment pointing anywhere.
struct ChainOptions {
  std::int64_t frames = 400;                    ///< 1 to 10 million
  double rate_hz = 60.0;                        ///< > 0; of the time base alone
  std::vector<double> lengths_m{0.150, 0.160};  ///< 2 segments or more, > 0
  int markers_per_segment = 3;                  ///< at even steps: length k / (n + 1)
  bool last_at_end = false;   ///< at length k / n instead: the last one lies at the segment's end
  double stagger_m = 0.0;     ///< distance of the markers from the bone's axis, >= 0
  bool planar = false;        ///< staggered to both sides in one plane, not all around the bone
  double noise_sd_m = 0.001;  ///< per axis, >= 0
  double missing = 0.0;       ///< 0 to 0.95, share of samples lost, each on its own
  /// Losses depend on the pose: none while the chain's end points away from a certain side, twice the share
  /// (0.98 at most) while it points there, as near an animal's mouth.
  bool pose_correlated = false;
  std::uint64_t seed = 1;  ///< of poses, noise and losses

  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// The chain starts at the origin. Markers are named "s0m0", ..., segments "s0", ..., joints "j0", ...
[[nodiscard]] Result<LimbRecording> simulate_chain(const ChainOptions& options);

/// Options of simulate_sleeve(): a macaque's arm, reaching for food and bringing it to the mouth at 60 Hz, 16
/// LEDs on a sleeve, straight segments of 150 and 160 mm about a right shoulder at the origin; x forward, y
/// to the left, z up.
struct SleeveOptions {
  double duration_s = 30.0;   ///< > 0
  double rate_hz = 60.0;      ///< > 0
  int leds_per_segment = 8;   ///< 2 to 32, in two helices around the limb
  double radius_m = 0.022;    ///< of the sleeve about the bone
  double noise_sd_m = 0.001;  ///< per axis
  bool line_of_sight = true;  ///< LEDs turned away from the cameras, or hidden by head and hand, are lost
  double sight_cosine = 0.2;  ///< a camera sees an LED within this cosine of its normal, -1 to 1
  int sight_cameras = 2;      ///< of six that must see an LED, 1 to 6
  double mouth_loss = 0.6;    ///< chance that an LED near the hand is hidden for a whole visit to the mouth
  bool obstacles = false;  ///< head, trunk and the cage's front bars stand between LEDs and cameras as well
  double missing = 0.0;    ///< share of samples lost besides, each on its own
  bool tip = false;        ///< one more LED, "w0", at the wrist, which shines along the forearm
  /// RMS distance that skin moves an LED on its bone, 0 to 1: in proportion to the rotation of elbow and
  /// shoulder from their means, each LED by itself and all of a segment as one body.
  double skin_m = 0.0;
  std::uint64_t seed = 1;  ///< of poses, noise, losses and skin

  /// Three cameras, a narrow beam, 0.9 hidden at the mouth and a fifth of the rest lost: about 30 % is seen.
  [[nodiscard]] static SleeveOptions hard();
  [[nodiscard]] std::int64_t frames() const;  ///< frames that the duration and rate give
  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// Segments "upper_arm" and "forearm", joint "elbow", markers "u0", ..., "f0", ...; the "shoulder" stays, and
/// with a tip the "wrist" is an end.
[[nodiscard]] Result<LimbRecording> simulate_sleeve(const SleeveOptions& options);

}  // namespace kinemark::simulation
