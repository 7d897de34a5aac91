// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Real movements that are known: exact models, posed as people were in recordings.
#pragma once

#include <Eigen/Core>

#include "acceptance/ik_recordings.h"

namespace kinemark::testing_support {

/// A movement, and the markers that an exact model has there.
struct RealMovement {
  Eigen::MatrixXd q;  ///< n x F, rad and m
  data::Trajectories markers;
};

/// Angles of a recording as least squares has them, low-passed at 20 Hz (what is faster is its noise), and
/// the model's markers there.
/// @param rate_hz  of its frames; that of the recording, or another
[[nodiscard]] RealMovement real_movement(const IkCase& c, double rate_hz);

}  // namespace kinemark::testing_support
