// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/core/result.h"
#include "kinemark/stages/simulation/rig_scene.h"
#include "studies/poizner/calibrated_rig.h"
#include "studies/poizner/coverage.h"
#include "studies/poizner/wheel_measures.h"

namespace kinemark::studies {

/// Root mean square errors of position, velocity and acceleration (3-D), SI units.
struct MotionErrors {
  double position = 0.0, velocity = 0.0, acceleration = 0.0;
};

struct WheelOutcome {
  WheelMeasures classic_raw, classic, ours;
  MotionErrors classic_errors, our_errors, predicted;  ///< predicted: standard deviations that came with ours
  Coverage positions, rates;
  Eigen::Matrix3Xd classic_path, our_path;  ///< m, true world
  double cutoff_hz = 0.0;
  int order = 0;
};

/// Scenario S2: 220 frames at 100 Hz of the turning wheel.
[[nodiscard]] Result<WheelOutcome> study_wheel(const CalibratedRig& rig,
                                               const simulation::WheelOptions& wheel);

/// Errors of a path (columns: frames [first, last)) against the truth of LED `led`.
[[nodiscard]] MotionErrors motion_errors(const Eigen::Matrix3Xd& position, const Eigen::Matrix3Xd& velocity,
                                         const Eigen::Matrix3Xd& acceleration,
                                         const data::Trajectories& truth, const data::Derivatives& rates,
                                         std::int64_t led, std::int64_t first, std::int64_t last);

/// An LED's smoothed motion with its standard deviations, turned into the true world; columns: frames.
struct AlignedPath {
  Eigen::Matrix3Xd position, velocity, acceleration;
  Eigen::Matrix3Xd position_sd, velocity_sd, acceleration_sd;
};

[[nodiscard]] AlignedPath aligned_path(const data::Trajectories& points, const data::Derivatives& rates,
                                       std::int64_t led, const math::SE3& truth_from_world);

/// Standard deviations in the form of the errors: root mean square over frames of the 3-D length.
[[nodiscard]] MotionErrors predicted_errors(const AlignedPath& path, std::int64_t first, std::int64_t last);

/// Count errors of position, and of velocity and acceleration, against their standard deviations.
void add_coverage(const AlignedPath& path, const data::Trajectories& truth, const data::Derivatives& rates,
                  std::int64_t led, std::int64_t first, std::int64_t last, Coverage& positions,
                  Coverage& derivatives);

}  // namespace kinemark::studies
