// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "kinemark/data/rig.h"

namespace kinemark::reconstruction {

/// Detector ratios (u, v) of four counts in the order +x, -x, +y, -y; NaN where a pair adds up to nothing.
[[nodiscard]] Eigen::Vector2d detector_ratios(const Eigen::Vector4d& counts);

/// The correction of 1986: position on the grid's plane of a spot with these ratios, m right and down of the
/// plane's middle, by quadratic interpolation (Lagrange, 3 x 3 nodes around the nearest one), inverted by
/// Newton steps. Beyond the outermost nodes it extrapolates, up to four spacings, as the method does. NaN in,
/// NaN out. The table needs 3 x 3 nodes or more.
[[nodiscard]] Eigen::Vector2d look_up(const data::RatioTable& table, const Eigen::Vector2d& ratio);

/// Midpoint of the shortest line between the rays of the first two cameras, each through its lens centre and
/// a point of its grid plane, with the poses as they stand in the rig. NaN when a ray is NaN or both are
/// parallel.
/// @param on_plane  what look_up() gave for each camera, m
[[nodiscard]] Eigen::Vector3d meet_midway(std::span<const data::Camera> cameras,
                                          std::span<const Eigen::Vector2d> on_plane);

}  // namespace kinemark::reconstruction
