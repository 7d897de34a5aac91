// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/data/derivatives.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::trajectory {

/// Tell, with the smoothed paths of LEDs, what they were smoothed by and what each frame alone would have
/// given: measuring afterwards can then be as good as on the frames.
///
/// The points of `start` that were measured are moved from the time of their light to that of their frame
/// along the smoothed path, by its velocity and acceleration; what is left between both is the noise of a
/// frame. Its standard deviation per axis (median of the magnitudes, what the path itself is uncertain by
/// added) becomes that of the filter.
///
/// @param start  F x M points of each frame alone, with their sample_offset_s
/// @param rates  of `smoothed`, with the filters
void hand_on_start(const data::Trajectories& start, const data::Derivatives& rates,
                   data::Trajectories& smoothed);

}  // namespace kinemark::trajectory
