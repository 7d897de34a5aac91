// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A model without lengths: its bodies turn as the given one's, all about one point. Orientations of sensors
// are then points that are seen: the tips of their axes.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/orientations.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"

namespace kinemark::motion::internal {

/// Angular velocity of a body (tree index), world axes, by the speeds: A is 3 x nv already. After
/// kinematics().
inline void turning_jacobian(const model::Model& model, const model::Workspace& w, int body,
                             Eigen::MatrixXd& A) {
  A.setZero();
  for (const int c : model.bodies()[at(body)].support)
    A.col(model.columns()[at(c)].speed) += w.column[at(c)].w;
}

/// Length of the axes, m. Only the check of units in solve_ik() asks for one of a body's size.
inline constexpr double kAxis_m = 1.0;

/// The tips of three axes scatter per axis by so much for one of an orientation about each axis, in metres
/// for radians: then the covariance of the coordinates is the same.
inline constexpr double kTipNoise_m = 1.4142135623730951 * kAxis_m;

/// One sensor on a body.
struct SensorTips {
  std::int64_t column = 0;  ///< in the recording
  int body_idx = 0;         ///< of the description
  Eigen::Matrix3d body_from_sensor = Eigen::Matrix3d::Identity();
};

/// Joints without offsets and translations, no loops, the markers of the sensors: three a sensor, in order.
/// Coordinates and couplings keep their places.
[[nodiscard]] data::ModelDescription turning_model(const data::ModelDescription& model,
                                                   const std::vector<SensorTips>& sensors);

/// Whether a coordinate turns a body, by itself or through one that follows it.
[[nodiscard]] std::vector<bool> turning_coordinates(const data::ModelDescription& model);

/// The tips as a recording of markers. @param frames  of the recording, in order; `model_from_world` turns
/// them all
[[nodiscard]] data::Trajectories record_tips(const data::Orientations& recording,
                                             const std::vector<SensorTips>& sensors,
                                             const Eigen::Matrix3d& model_from_world,
                                             const std::vector<std::int64_t>& frames);

/// Angle of which three distances of tips, squared and summed, tell: rad.
[[nodiscard]] double angle_of_tips(double squares_m2);

}  // namespace kinemark::motion::internal
