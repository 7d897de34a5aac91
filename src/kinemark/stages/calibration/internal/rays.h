// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "kinemark/camera/projection.h"
#include "kinemark/data/rig.h"

namespace kinemark::calibration::internal {

/// Position of the spot on the sheet (half-sides) from four readings without offset, by Gauss-Newton from the
/// middle. No value when they are dark.
[[nodiscard]] std::optional<Eigen::Vector2d> find_spot(const data::Detector& detector,
                                                       const Eigen::Vector4d& readings);

/// Line of sight of an observation, by find_spot() and camera::unproject().
[[nodiscard]] std::optional<camera::Ray> line_of_sight(const data::Camera& camera,
                                                       const Eigen::Vector4d& counts);

/// Point nearest to two rays or more; none when they are parallel.
[[nodiscard]] std::optional<Eigen::Vector3d> meet(std::span<const camera::Ray> rays);

}  // namespace kinemark::calibration::internal
