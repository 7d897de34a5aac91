// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A small body for the tests of this folder: a free trunk, an arm with an oblique elbow, a leg whose knee
// moves on a spline and drives a kneecap, 14 markers.
#pragma once

#include <Eigen/Core>

#include "kinemark/data/joint_motion.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"

namespace kinemark::motion::testing_body {

[[nodiscard]] data::ModelDescription description();

/// Smooth coordinates of frame f of a moving body, n numbers within the limits.
[[nodiscard]] Eigen::VectorXd coordinates(const model::Model& model, std::int64_t frame,
                                          double rate_hz = 100.0);

/// Markers of the moving body; every marker gets noise_sd_m per axis from the seed.
[[nodiscard]] data::Trajectories record(const model::Model& model, std::int64_t frames,
                                        double noise_sd_m = 0.0, std::uint64_t seed = 1);

/// Root mean square difference of joint angles (root left out) to the moving body's, rad, after `skip`
/// frames.
[[nodiscard]] double angle_rms(const model::Model& model, const data::JointMotion& motion,
                               std::int64_t skip = 0);

}  // namespace kinemark::motion::testing_body
