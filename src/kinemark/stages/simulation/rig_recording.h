// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A recording of the rig: LEDs lit in turn, every electrode converted at its own time.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/derivatives.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/simulation/rig_physics.h"
#include "kinemark/stages/simulation/rig_scene.h"

namespace kinemark::simulation {

inline constexpr int kMostLeds = 8;  ///< that the rig can drive

/// Options of record().
struct RigRecordingOptions {
  double rate_hz = 100.0;              ///< frames per second; limited by the time slots of all LEDs
  std::int64_t frames = 400;           ///< at least 1; frames times LEDs at most 10 million
  double t0_s = 0.0;                   ///< time of frame 0
  std::vector<double> intensity;       ///< per LED, >= 0; empty: 1. Half the light: 0.5
  std::uint64_t seed = 1, stream = 0;  ///< of the noise
  bool noise = true;  ///< of amplifier and converter; flicker, stray light and rounding are always there
  int threads = 1;    ///< 0: all cores. Any number gives the same bits

  /// Ranges hold, and frames are long enough for one slot per LED and, where the rig has one, a dark slot.
  [[nodiscard]] Status check(const data::Rig& rig, int leds) const;
};

/// Why a camera got no light of an LED; bits.
enum HiddenFlag : std::uint8_t {
  kHiddenOccluded = 1,  ///< something stood in between
  kHiddenOffSheet = 2,  ///< the spot missed the detector at one conversion or more
  kHiddenDark = 4,      ///< the LED did not shine
};

/// Counts of a moving scene, and the truth.
struct RigRecording {
  data::Counts counts;            ///< as recorded; saturation is flagged, occlusion is left to reconstruction
  data::Trajectories truth;       ///< every LED at the time of the frame
  data::Derivatives derivatives;  ///< velocity and acceleration there
  data::Trajectories when_lit;    ///< every LED in the middle of its conversions (sample_offset_s)
  Array<std::uint8_t> hidden;     ///< F x L x C, bits of HiddenFlag
};

/// Convert a scene. Conversion k of LED l and camera c of frame f is at t_f + offset(l, c, k)
/// (data::SlotTiming) and sees the light of one amplifier time constant earlier; flicker and mirrors are
/// evaluated at the time of the conversion.
///
/// Noise: Random(seed, stream); per LED, per camera: four amplifier draws for every frame, then four
/// converter draws for every frame. The dark slot draws from stream + 2^32. About 2 us per observation on one
/// thread.
[[nodiscard]] Result<RigRecording> record(const PhysicalRig& rig, const RigScene& scene,
                                          const RigRecordingOptions& options = {});

}  // namespace kinemark::simulation
