// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measurement model of a lateral-effect camera for a point light source: counts = S * phi(point) + offset,
// with S the unknown strength of the light (counts) and phi the response of the four channels.
#pragma once

#include <Eigen/Core>

#include "kinemark/data/rig.h"

namespace kinemark::camera {

/// What the four channels of a lateral-effect camera say of a point light, and where it falls.
struct Response {
  Eigen::Vector4d phi;                  ///< of channels +x, -x, +y, -y; sum near 1 (duo-lateral: 2)
  Eigen::Matrix<double, 4, 3> d_point;  ///< by the point in the world, per m
  Eigen::Vector2d spot;                 ///< on the sheet, half-sides
  bool in_front = false;                ///< the point is before the camera; elsewhere phi means nothing
  bool on_sheet = false;                ///< the spot lies within the detector's edge
};

/// Columns by the layout of data::ParameterLayout: 4 x count.
using ResponseJacobian = Eigen::Ref<Eigen::Matrix<double, 4, Eigen::Dynamic>>;

/// phi_k = gain_k * sum_j h_j(spot) (1 + crosstalk)_jk, spot = project(camera, point). No allocation; some
/// 0.5 us with a warp of degree 5, 0.8 us with degree 10.
[[nodiscard]] Response respond(const data::Camera& camera, const Eigen::Vector3d& x_in_world);

/// The same, and the derivatives by the camera's parameters (overwritten; columns of offset are 0, because
/// offsets do not belong to phi).
[[nodiscard]] Response respond(const data::Camera& camera, const Eigen::Vector3d& x_in_world,
                               ResponseJacobian d_parameters);

/// Response at a known position on the sheet (half-sides, warp included), with derivatives by that position.
struct SpotResponse {
  Eigen::Vector4d phi;                 ///< of channels +x, -x, +y, -y
  Eigen::Matrix<double, 4, 2> d_spot;  ///< by the place of the spot, per half-side
};
/// @param spot  half-sides; beyond the detector's edge it counts as lying there. O(terms of the warp);
/// allocates nothing.
[[nodiscard]] SpotResponse respond_at(const data::Detector& detector, const Eigen::Vector2d& spot);

}  // namespace kinemark::camera
