// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/simulation/rig_scene.h"

namespace kinemark::simulation {

/// Recorded or simulated markers carried as LEDs.
struct MarkerSceneOptions {
  std::vector<std::string> markers;  ///< 1 to kMostLeds names; empty: all, if they are not more
  bool z_is_up = false;              ///< the laboratory's Z points up; turned so that Y does
  bool centred = true;               ///< the middle of the markers' bounding box goes to the rig's origin
};

/// LEDs where markers were: natural cubic splines through each run of present samples, at the time the sample
/// was really taken. Outside its runs an LED does not shine. All LEDs shine along Z, towards the cameras.
/// Time 0 is the first frame's. Runs of one sample are left out. Fails when a marker is not there or never
/// seen, or there are too many.
[[nodiscard]] Result<RigScene> markers_as_leds(const data::Trajectories& markers,
                                               const MarkerSceneOptions& options = {});

}  // namespace kinemark::simulation
