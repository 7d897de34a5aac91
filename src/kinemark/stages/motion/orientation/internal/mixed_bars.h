// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Noise and error bars of markers and sensors together. Sensors enter by the turning of their bodies alone.
// Theory: docs/theory/orientations.md
#pragma once

#include <Eigen/Core>

#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/internal/error_bars.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {

// Orientations beside markers: a body that a sensor turns carries four points so far away that where the body
// is hardly counts. Theory: docs/theory/orientations.md

/// Distance of the points, m: their sum of squares about each axis is its square.
inline constexpr double kFar_m = 30.0;
inline constexpr int kCorners = 4;  ///< points of a sensor

/// Corners of a tetrahedron about the body's origin, m: their sum is 0, that of their products with
/// themselves kFar_m^2 times the identity. So the squared distances of the corners of two bodies add up to
/// kFar_m^2 |R - S|^2 (Frobenius) and kCorners times the squared distance of their origins, and nothing else.
[[nodiscard]] Eigen::Matrix<double, 3, kCorners> far_corners();

/// Weight of a corner beside markers of weight 1: variance of an orientation about each axis (rad^2), and of
/// a marker per axis (m^2).
[[nodiscard]] double far_weight(double marker_variance_m2, double orientation_variance_rad2);

/// The model with the corners of sensors on these bodies (of the description) behind its markers.
[[nodiscard]] data::ModelDescription add_far_points(data::ModelDescription model,
                                                    const std::vector<int>& bodies);

/// The recording with the corners behind its markers.
/// @param turned  world_from_body of each sensor, F x S; NaN where it is missing
/// @param origin  about where the body is, F x S, m
[[nodiscard]] data::Trajectories add_far_points(const data::Trajectories& markers,
                                                const std::vector<Eigen::Matrix3d>& turned,
                                                const std::vector<Eigen::Vector3d>& origin);

/// Sensors as they take part in F frames.
struct TurnedBodies {
  std::vector<int> body;                    ///< S, tree index
  std::vector<Eigen::Matrix3d> turned;      ///< F x S, world_from_body as the sensor says; NaN where missing
  std::vector<Eigen::Vector3d> by_heading;  ///< F x S, turn of that in the world for one of the heading
  std::vector<double> placing_variance;  ///< S, of how the sensor stands on its body, rad^2 about each axis
  std::vector<double> placing_share;     ///< S, the same as a share of the noise: a pose has it in each frame
  double heading_variance = 0.0;         ///< rad^2
  double noise_variance = kNaN;          ///< of an orientation about each axis, rad^2
  double marker_variance = kNaN;         ///< of a marker of weight 1 per axis, m^2

  [[nodiscard]] std::size_t size() const { return body.size(); }
  [[nodiscard]] bool present(std::size_t frame, std::size_t sensor) const {
    return turned[frame * size() + sensor].allFinite();
  }
};

/// Variances by the residuals at the solved states: squares over the numbers that are measured less the share
/// of the pose that each kind determines. NaN where nothing is left over. Every k-th frame is used, 300 at
/// most.
struct MixedNoise {
  double marker_variance = kNaN;  ///< of a marker of weight 1 per axis, m^2
  double sensor_variance = kNaN;  ///< of an orientation about each axis, rad^2
};
/// @param problem  its last points are those of the sensors, kCorners each
/// @param points   markers and far points
[[nodiscard]] MixedNoise estimate_mixed_noise(const Problem& problem, const data::Trajectories& points,
                                              const Eigen::MatrixXd& states, const TurnedBodies& sensors);

/// Fill q_sd, determined and open_frames of `motion`, whose q is set, as compute_error_bars() does.
/// @param variances  of all points
void compute_mixed_bars(const Problem& problem, const data::Trajectories& points,
                        const Eigen::MatrixXd& states, const MarkerVariances& variances,
                        const TurnedBodies& sensors, int threads, data::JointMotion& motion);

}  // namespace kinemark::motion::internal
