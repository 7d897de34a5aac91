// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Where a velocity jumps from one sample to the next, as at an impact or a tap.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/math/difference_smoother.h"

namespace kinemark::analysis::internal {

/// A velocity that changes quicker than samples can tell.
struct VelocityJump {
  double at = 0.0;  ///< sample, with its fraction
  /// What velocity, acceleration and its rate are behind it, less what they are before it: a row each, over
  /// 1, 2 and 6 powers of a sample; 0 where they are not known to change.
  Eigen::Matrix3d change = Eigen::Matrix3d::Zero();
};

/// Find jumps of the velocity in samples with noise, in order of time.
///
/// About a jump, 0.15 s to both sides, positions are a polynomial of degree 5 and a ramp that begins there.
/// The ramp's size is estimated at every sample; the quarter of all samples with the least tells what noise
/// makes of it. Where these quiet samples leave more beside their polynomials than 1.25 times the white noise
/// that neighbours show, nothing is claimed. A jump is what stands out by 20 nats and leaves no more than 1.5
/// times what quiet samples leave, acceleration and its rate allowed to jump as well; it is 5 nats likelier
/// than a jump of acceleration or its rate alone within 75 ms, or as likely where there is another jump. A
/// quick movement, a corner that is rounded, a sharp stop and a single wrong sample are none. Single missing
/// samples are bridged. None is found below 80 samples a second, within 0.15 s of a longer gap or an end, and
/// where jumps fill more than two thirds of the time.
/// @param x  n x 3
/// Cost: 60 n at 100 samples a second.
[[nodiscard]] std::vector<VelocityJump> find_velocity_jumps(const math::SeriesMatrix& x,
                                                            const std::vector<bool>& seen, double rate_hz);

/// The series without what begins at jumps: as smooth as the movement between them, and with the
/// same noise.
[[nodiscard]] math::SeriesMatrix without_jumps(const math::SeriesMatrix& x,
                                               const std::vector<VelocityJump>& jumps);

}  // namespace kinemark::analysis::internal
