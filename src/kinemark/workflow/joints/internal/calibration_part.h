// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the calibration of the cameras leaves unknown of joint centres and lengths.
#pragma once

#include "kinemark/data/skeleton.h"
#include "kinemark/data/trial.h"

namespace kinemark::workflow::internal {

/// Adds it to the covariances of centres and ends in the world and to the deviations of lengths: a centre is
/// displaced as the room is at its place. Places in segments keep theirs: markers and centre move nearly
/// alike. Deviations that are not known stay so. O(F J).
/// @return RMS of a centre's displacement over frames and joints, m; 0 where nothing is known of the
/// calibration
double add_calibration_error(const data::CalibrationError& error, data::Skeleton& skeleton);

}  // namespace kinemark::workflow::internal
