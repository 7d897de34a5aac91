// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The rig of 1986 with random manufacturing errors drawn from a seed, which are unknown to the operator.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/rig.h"

namespace kinemark::simulation {

/// LEDs and lenses. Values: Poizner, Wooten & Salot (1986) and data sheets;
/// docs/theory/lateral-effect-detector.md.
struct RigLight {
  double led_power_w = 0.35;       ///< radiant, pulsed, into a hemisphere by Lambert's law
  double focal_length_m = 25e-3;   ///< of the lens
  double f_number = 1.85;          ///< focal length over aperture
  double distance_m = 3.0;         ///< of the cameras from the middle; lenses are focused there
  double transmission = 0.80;      ///< of the lens
  double responsivity_a_w = 0.60;  ///< of the detector
  double stray_share = 0.006;  ///< light by way of the room, per light of an LED on the axis at distance_m
  double flicker_hz = 120.0;   ///< of the room's lamps
};

/// Photocurrent (A) of a camera that an LED of relative intensity 1 lights, from its distance and the cosines
/// of the angles at which the light leaves the LED and meets the lens.
[[nodiscard]] double photocurrent_a(const RigLight& light, double distance_m, double cos_led,
                                    double cos_camera);

/// Light from the room at one camera.
struct RoomLight {
  Eigen::Vector4d stray = Eigen::Vector4d::Zero();  ///< share of the stray light at each electrode
  double flicker_counts = 0.0;                      ///< amplitude, the same at all electrodes
  double flicker_phase_rad = 0.0;                   ///< at time 0
};

/// A rig with all effects on its counts.
struct PhysicalRig {
  data::Rig rig;                ///< the truth, but for the room's light; see rig_in_room()
  data::Rig nominal;            ///< the operator's nominal values: drawings, and poses set by hand
  RigLight light;               ///< LED, lens and distance
  std::vector<RoomLight> room;  ///< per camera
  std::uint64_t seed = 1;       ///< of everything that was drawn
};

inline constexpr double kPedestal_counts = 16.0;  ///< that a dark slot raises all channels by

/// Options of draw_rig().
struct RigDrawOptions {
  std::uint64_t seed = 1;     ///< of everything that is drawn
  double imperfection = 1.0;  ///< >= 0, times the tolerances of lens, sheet, channels and lamps
  double misalignment = 1.0;  ///< >= 0, times the errors of poses set by hand
  data::DetectorKind detector = data::DetectorKind::tetra_lateral;  ///< not generic
  double convergence_deg = 60.0;                                    ///< between the cameras' axes, 10 to 150
  double crosstalk = 0.0;  ///< 0 to 0.5: share of every current that strays to electrodes at random
  double ripple = 0.0;     ///< >= 0, sd of further warp terms of degree 6 to 10, half-sides
  bool dark_slot =
      false;      ///< also raises all channels by 16 counts, so that darkness is within the converter
  int bits = 12;  ///< of the converter, 8 to 14. What is given in counts is in those of 12 bits
  double conversion_s = 48e-6;  ///< of one channel, 1e-6 to 1e-3
  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// Two cameras, A on the left, at 3 m from the world's origin (X right, Y up, Z towards them), 60 degrees
/// apart by default. Random(seed, 100 + camera) draws, in this order: lens centre 3 x 10 mm; roll 3 mrad, yaw
/// and pitch 0.5 mrad; focal length 0.6 %; principal point 2 x 0.08 mm; k1 -0.20 +- 15 %; p1, p2 5e-4; warp
/// of degree 2 to 5, term by term x then y, 0.3 % of the half-side; gains 0.5 %; offsets 2 counts; phase of
/// the flicker of 1 count. Random(seed, 900 + camera): crosstalk and ripple.
[[nodiscard]] Result<PhysicalRig> draw_rig(const RigDrawOptions& options = {});

/// Pose of a camera whose lens is at `centre` (m in world) and that looks at the origin, upright, then rolls,
/// turns and tilts by small angles (rad).
[[nodiscard]] math::SE3 looking_at_origin(const Eigen::Vector3d& centre, double roll_rad = 0.0,
                                          double yaw_rad = 0.0, double pitch_rad = 0.0);

/// An LED as a camera sees it.
struct LedState {
  Eigen::Vector3d x_in_world = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();     ///< unit vector along which it shines most
  bool shining = true;                                   ///< false: it is switched off
};

/// Expected counts of one camera: light of the LED (none if it is behind the camera or misses the sheet),
/// stray light and offset; neither flicker nor noise.
struct ExpectedCounts {
  Eigen::Vector4d counts;  ///< of channels +x, -x, +y, -y
  bool on_sheet = true;    ///< whether light falls on the detector
};
/// @param intensity  >= 0, of the LED's power
[[nodiscard]] ExpectedCounts expected_counts(const PhysicalRig& rig, int camera, const LedState& led,
                                             double intensity = 1.0);

/// The true rig as a calibration by LEDs of relative intensity 1 finds it: their light that comes by way of
/// the room is in the offsets (data::Detector). Without it, points lie up to some millimetres nearer the
/// axes.
[[nodiscard]] data::Rig rig_in_room(const PhysicalRig& rig);

/// Light that reaches a camera by way of a mirror: as from a second position, with a share of the LED's
/// intensity.
[[nodiscard]] Eigen::Vector4d reflected_counts(const PhysicalRig& rig, int camera, const LedState& led,
                                               double intensity, const Eigen::Vector3d& position_in_world,
                                               double share);

}  // namespace kinemark::simulation
