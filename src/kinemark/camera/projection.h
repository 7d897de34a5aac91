// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// From a point in the world to its position in the image, and back to a ray: pinhole and lateral-effect
// cameras.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "kinemark/data/rig.h"

namespace kinemark::camera {

/// Where a camera sees a point, in pixels (pinhole) or half-sides of the sheet, warp included
/// (lateral-effect).
struct Projection {
  Eigen::Vector2d image;                ///< x right, y down
  Eigen::Vector3d x_in_cam;             ///< m
  Eigen::Matrix<double, 2, 3> d_point;  ///< by the point in the world, per m
  bool in_front = false;                ///< depth > 0; elsewhere image is the mirrored one and means nothing
  /// True when image lies within the detector's edge; always for a pinhole camera.
  bool on_sheet = false;
};

/// Columns by the layout of data::ParameterLayout up to the warp: 2 x ParameterLayout::crosstalk (for a
/// pinhole camera that is all of them, 15).
using ImageJacobian = Eigen::Ref<Eigen::Matrix<double, 2, Eigen::Dynamic>>;

/// @param x_in_world m. A point in the plane of the lens gives numbers that are not finite.
[[nodiscard]] Projection project(const data::Camera& camera, const Eigen::Vector3d& x_in_world);

/// The same, and the derivatives by the parameters that move the image (overwritten). No allocation.
[[nodiscard]] Projection project(const data::Camera& camera, const Eigen::Vector3d& x_in_world,
                                 ImageJacobian d_parameters);

/// A line of sight.
struct Ray {
  Eigen::Vector3d origin_in_world;     ///< the centre of the lens, m
  Eigen::Vector3d direction_in_world;  ///< of unit length, away from the camera
};

/// The ray that belongs to an image position: inverse of project() by Newton's method. No value where warp
/// or distortion have no inverse.
[[nodiscard]] std::optional<Ray> unproject(const data::Camera& camera, const Eigen::Vector2d& image);

}  // namespace kinemark::camera
