// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How sensors stand on bodies, and their heading, where markers say how the bodies are turned.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/orientations.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/orientation/internal/heading.h"
#include "kinemark/stages/motion/orientation/internal/sensor_placement.h"

namespace kinemark::motion::internal {

/// How the markers of a frame say that a body is turned.
struct MarkedTurn {
  Eigen::Matrix3d world_from_body = Eigen::Matrix3d::Identity();
  double variance = std::numeric_limits<double>::infinity();  ///< about its vaguest axis, rad^2
};

/// Of the bodies of all sensors in some frames, n x S.
/// @param states       of the problem, one column per frame
/// @param information  M, 1/m^2 of each marker per axis
[[nodiscard]] std::vector<MarkedTurn> find_marked_turns(
    const Problem& problem, const data::Trajectories& markers, const Eigen::MatrixXd& states,
    const Eigen::VectorXd& information, const PosedSensors& posed, const std::vector<std::int64_t>& frames);

/// Sensors beside bodies that markers turn. A body counts in frames in which the markers fix it to 2 deg;
/// where no pose places the sensors, to 0.1 rad.
class MarkerMounts {
 public:
  /// @param posed      must outlive it
  /// @param recording  on the frames of the markers
  MarkerMounts(const PosedSensors& posed, const data::Orientations& recording,
               const std::vector<MarkedTurn>& turns, const std::vector<std::int64_t>& frames);

  /// Whether 10 frames or more say how the sensor stands on its body.
  [[nodiscard]] bool by_markers(std::size_t sensor) const;
  /// How it stands there under a heading, as those frames say.
  [[nodiscard]] Eigen::Matrix3d body_from_sensor(std::size_t sensor, double heading_rad) const;
  /// Variance of that about each axis, rad^2.
  [[nodiscard]] double variance(std::size_t sensor) const;
  /// The heading under which sensors and markers agree best. Errors of frames beside each other are alike:
  /// one in 0.2 s counts, 24 at most. Code::bad_input as choose_heading().
  [[nodiscard]] Result<Heading> find_heading() const;

 private:
  /// Sum over frames of a sensor, each by its information: body' Rot(heading) sensor is its value at any
  /// heading.
  struct Sums {
    Eigen::Matrix3d along = Eigen::Matrix3d::Zero(), cosine = Eigen::Matrix3d::Zero(),
                    sine = Eigen::Matrix3d::Zero();
    double information = 0.0;  ///< 1/rad^2
    std::int64_t frames = 0;
    [[nodiscard]] Eigen::Matrix3d value(double heading_rad) const;
  };
  [[nodiscard]] double cost(double heading_rad) const;

  const PosedSensors& posed_;
  std::vector<Sums> sums_;
  double independent_ = 1.0;  ///< frames whose errors are not alike
};

}  // namespace kinemark::motion::internal
