// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"

namespace kinemark::motion {

/// Covariance of coordinates and their rates, for each coordinate separately (errors of different coordinates
/// are taken as independent).
struct RateErrors {
  /// F x n x 6: covariance of q, qd, qdd, its upper triangle by rows. Zero where locked; NaN where a
  /// coordinate was never determined and for coupled coordinates.
  Array<double> covariance;
  /// n, noise of each coordinate as the smoother found it, over its q_sd, or in rad and m where there is
  /// none; empty: not known.
  Array<double> noise_scale;
};

/// Estimate dq/dt, d2q/dt2 and their covariance from the coordinates alone.
///
/// Every independent coordinate is smoothed by itself (coordinate_smoother.h), weighted by q_sd and left open
/// where it is not determined; bandwidth and noise follow from its own likelihood. q stays as it is. qd and
/// qdd are filled only where they are empty. The angles of a free root are smoothed as angles: near the
/// attitude where the middle one is 90 deg prefer the smoother on the whole body. Fails below 8 frames.
[[nodiscard]] Result<RateErrors> estimate_rates(const model::Model& model, data::JointMotion& motion);

/// Covariance of one coordinate of a frame, as the motion holds it (not smoothed: at least its q_sd, or the
/// noise that was found), with its smoothed rates: upper triangle by rows.
[[nodiscard]] std::array<double, 6> covariance_as_held(const data::JointMotion& motion,
                                                       const RateErrors& errors, std::int64_t frame,
                                                       std::int64_t coordinate);

}  // namespace kinemark::motion
