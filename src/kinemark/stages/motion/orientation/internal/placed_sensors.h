// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/stages/motion/orientation/internal/marker_mounts.h"
#include "kinemark/stages/motion/orientation/internal/mixed_bars.h"

namespace kinemark::motion::internal {

/// How the sensors say that their bodies are turned, in all their frames. A sensor is placed by the model, by
/// markers, or by the pose, in this order; `fit` gets those that are, with what placed them, and the names of
/// those that nothing places. Noise of sensors and markers is left open.
/// @param sensors  on the frames of the markers
[[nodiscard]] TurnedBodies turn_bodies(const model::Model& model, const data::Orientations& sensors,
                                       const PosedSensors& posed, const MarkerMounts& mounts,
                                       const Heading& heading, OrientationFit& fit);

}  // namespace kinemark::motion::internal
