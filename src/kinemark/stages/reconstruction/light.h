// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How brightly the LEDs of a recording shine. Theory: docs/theory/reconstruction.md, "Light".
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "kinemark/camera/light.h"
#include "kinemark/core/array.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::reconstruction {

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
  camera::Light light;                        ///< relative to the LEDs of the calibration
  camera::Light stray;                        ///< what its light by way of the room is: sets the offsets
  std::vector<double> strength_counts;  ///< C, medians of the counts that it makes; 0 where it is not seen
  /// F x C, light as each camera sees it, facing the LED from 1 m: light times the cosine of the LED's
  /// direction. NaN where it is not seen or the rig does not know its cameras' constants.
  Array<double> seen;
};

/// Light of each LED of a recording, from the points that the rig's own offsets gave.
///
/// The strength of an LED in a camera is its light times the cosine between its direction and the camera,
/// over the square of the distance; two cameras give light and direction where the direction stays. The
/// room's light adds a share of the LED's own to every channel, which counts alone show too: three of the
/// eight numbers of a frame do not serve the point. Both are joined: the room returns a light that the
/// strength foretells to 10 %.
///
/// @param points  F x L, from reconstruct() with the rig's own offsets
/// @param used    F x L x C, which observations served
/// Some 400 frames of each LED are looked at: 10 ms an LED.
[[nodiscard]] std::vector<LedLight> find_lights(const data::Counts& counts, const data::Rig& rig,
                                                const data::Trajectories& points,
                                                std::span<const std::uint8_t> used, double flicker_counts);

}  // namespace kinemark::reconstruction
