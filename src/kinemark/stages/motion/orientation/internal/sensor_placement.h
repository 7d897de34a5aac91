// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/orientations.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/orientation/orientation_ik.h"

namespace kinemark::motion::internal {

/// Sensors that bodies carry, and how all of them are turned in the pose that places them.
struct PosedSensors {
  struct Sensor {
    std::int64_t column = 0;            ///< in the recording
    int body_idx = 0;                   ///< of the description
    Eigen::Matrix3d world_from_sensor;  ///< in the pose; the vertical is the model's already
    Eigen::Matrix3d world_from_body;    ///< of the model's default pose
    std::optional<Eigen::Matrix3d> body_from_sensor = {};  ///< where the model says it
  };
  std::vector<Sensor> sensors;
  bool by_model = false;  ///< all of them are placed by the model
  bool unplaced = false;  ///< only their bodies are known
  std::vector<std::string> left_out;
  Eigen::Matrix3d model_from_world = Eigen::Matrix3d::Identity();  ///< upright; the heading is still open
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();                   ///< of the model
  double drift_rad = 0.0;        ///< largest turn of a sensor from the first to the second half of the pose
  std::int64_t pose_frames = 1;  ///< that were averaged
};

/// Match sensors and bodies, turn them upright, average the pose.
[[nodiscard]] Result<PosedSensors> pose_sensors(const model::Model& model,
                                                const data::Orientations& recording,
                                                const data::Orientations* pose,
                                                const OrientationOptions& options);

/// The same without a pose: sensors are on their bodies, nobody says how, unless the model does.
[[nodiscard]] Result<PosedSensors> sensors_on_bodies(const model::Model& model,
                                                     const data::Orientations& recording,
                                                     const OrientationOptions& options);

/// Leave sensors out that none of these frames has. Code::bad_input where none is left.
[[nodiscard]] Status drop_unseen(const data::Orientations& recording, const std::vector<std::int64_t>& frames,
                                 PosedSensors& posed, std::vector<std::string>& never_seen);

/// body_from_sensor where the world of the sensors is turned by `heading_rad` about the vertical.
[[nodiscard]] Eigen::Matrix3d body_from_sensor(const PosedSensors& posed, const PosedSensors::Sensor& sensor,
                                               double heading_rad);

/// Turn about the vertical with which this axis faces along the model's x axis; Code::bad_input where the
/// recording has no such sensor or the axis is upright.
[[nodiscard]] Result<double> heading_of(const PosedSensors& posed, const data::Orientations& recording,
                                        const FacingAxis& facing);

}  // namespace kinemark::motion::internal
