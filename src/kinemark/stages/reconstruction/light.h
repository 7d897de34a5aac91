// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How brightly the LEDs of a recording shine. Theory: docs/theory/reconstruction.md, "Light".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/reconstruction/reconstruct.h"

namespace kinemark::reconstruction {

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
