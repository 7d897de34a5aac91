// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What rigid bodies on known paths, and the floor under them, do to the joint from which they hang.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace kinemark::analysis {

/// A rigid body in F frames, in the laboratory.
struct BodyTrack {
  double mass = 0.0;                                   ///< kg
  Eigen::Vector3d gyration = Eigen::Vector3d::Zero();  ///< radii about its axes through the centre, m
  Eigen::MatrixX3d centre;                             ///< F x 3, centre of mass, m
  std::vector<Eigen::Matrix3d> axes;                   ///< F, axes column by column
};

/// A force and its moment about the laboratory's origin in F frames.
struct WrenchTrack {
  Eigen::MatrixX3d force;   ///< F x 3, N
  Eigen::MatrixX3d moment;  ///< F x 3, N m

  /// F frames of nothing.
  [[nodiscard]] static WrenchTrack zero(std::int64_t frames);
  /// Add another one of as many frames.
  WrenchTrack& operator+=(const WrenchTrack& other);
  /// The moment about another point in frame f, N m.
  [[nodiscard]] Eigen::Vector3d moment_about(const Eigen::Vector3d& point, std::int64_t f) const;
};

/// What gravity and its own inertia (d'Alembert) do to a body: m (g - a), and - d(I w)/dt about its centre.
///
/// Derivatives are central differences of eighth order over nine frames; NaN in the first and last four
/// frames and where one of the nine is. Axes are differentiated, not angles, so that no lock matters.
/// @param gravity       m/s^2, downwards
/// @param angular_span  1 or 2: angular velocity by central differences over so many frames to either side,
///                      and its rate by the same again, which smooths as some vendors do; 0: eighth order
[[nodiscard]] WrenchTrack inertial_wrench(const BodyTrack& body, const Eigen::Vector3d& gravity,
                                          double rate_hz, std::int64_t angular_span = 0);

/// Angular velocity of axes in F frames, rad/s in the laboratory, by the same differences. F x 3.
[[nodiscard]] Eigen::MatrixX3d angular_velocity(const std::vector<Eigen::Matrix3d>& axes, double rate_hz);

}  // namespace kinemark::analysis
