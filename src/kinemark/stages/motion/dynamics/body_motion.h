// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Where the bodies and points of a model are along a motion, how fast they move and how they accelerate, each
// with a standard deviation.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/smoother/rates.h"

namespace kinemark::motion {

/// A point fixed in a body.
struct FollowedPoint {
  std::string name;                                     ///< for the columns of its table
  int body_idx = data::kGround;                         ///< body of the description, or data::kGround
  Eigen::Vector3d x_in_body = Eigen::Vector3d::Zero();  ///< m
  /// Whose axes the answer is given in, and for its position also whose origin; data::kGround: the world.
  /// Velocity and acceleration are those in the world, as in OpenSim's PointKinematics.
  int relative_to_idx = data::kGround;
};

/// What is followed.
struct BodyMotionOptions {
  std::vector<int> body_idx;          ///< B bodies of the description
  std::vector<FollowedPoint> points;  ///< P
  /// Rates of the bodies (not of the mass centre) in each body's own axes, as OpenSim's BodyKinematics with
  /// express_results_in_body_local_frame.
  bool rates_in_body = false;
  bool error_bars = true;  ///< compute sd
  int threads = 1;         ///< 0: all cores. Any number gives the same bits.
};

/// The motion of B bodies, of the model's mass centre and of P points: F frames.
///
/// Numbers of a frame, for each order (0 position, 1 velocity, 2 acceleration): six of each body (its mass
/// centre along x, y, z, m, m/s, m/s^2; then its attitude as body-fixed X-Y-Z angles, rad, its angular
/// velocity, rad/s, or acceleration, rad/s^2), three of the model's mass centre, three of each point.
struct BodyMotion {
  TimeBase time;                        ///< F = time.frames
  std::int64_t bodies = 0, points = 0;  ///< B, P
  Array<double> value;                  ///< F x 3 x (6 B + 3 + 3 P); NaN where the motion has no number
  /// Of the same shape, one standard deviation; NaN where a coordinate on the way is not determined; empty
  /// without error bars.
  Array<double> sd;

  [[nodiscard]] std::int64_t columns() const { return 6 * bodies + 3 + 3 * points; }  ///< of one order
  /// Index of a number in value and sd. @param column  in [0, columns())
  [[nodiscard]] std::size_t index(std::int64_t frame, int order, std::int64_t column) const {
    return static_cast<std::size_t>((3 * frame + order) * columns() + column);
  }
};

/// Follow bodies and points along a motion whose qd and qdd are there.
///
/// sd is of first order: the covariance of each coordinate with its rates (`errors`) through the derivatives
/// of what is followed. Errors of different coordinates are taken as independent. Those of coordinates that
/// markers found together are not: far from the root they partly cancel, so that sd is then too large. Errors
/// of the model are not in it. The mass centre of a massless model is NaN.
///
/// @param is_filled  F x n, or empty; 1: the motion has no number there, and what depends on it is NaN
/// @return Code::bad_input when the motion is not of the model or has no rates. About 10 us a frame, 1 ms
///         with error bars (whole body).
[[nodiscard]] Result<BodyMotion> body_motion(const model::Model& model, const data::JointMotion& motion,
                                             const BodyMotionOptions& options, const RateErrors& errors,
                                             const Array<std::uint8_t>& is_filled = {});

}  // namespace kinemark::motion
