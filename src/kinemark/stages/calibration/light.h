// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Light of the LEDs of a calibration.
#pragma once

#include <span>
#include <vector>

#include "kinemark/data/rig.h"
#include "kinemark/math/se3.h"
#include "kinemark/stages/calibration/still_poses.h"

namespace kinemark::calibration {

/// Sets light_counts of every camera: what LEDs like those of the calibration make, which shine with light 1
/// in the mean. An LED shines by the cosine to its own direction, which is not known but stays in the tree or
/// in the room, whichever fits better; a camera sees it by the cosine to its axis and by the inverse square
/// of the distance. Lights, directions and cameras' constants are found in turns, by least squares. Stays
/// unknown where a camera saw fewer than ten places. O(observations).
///
/// @param poses            what was seen; the rig must be calibrated with it
/// @param world_from_tree  for each pose; poses without a finite one are not used
void find_light_counts(const StillPoses& poses, std::span<const math::SE3> world_from_tree, data::Rig& rig);

}  // namespace kinemark::calibration
