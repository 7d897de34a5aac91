// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Corners of force plates as files have them: in another unit than the points, or around the edge in no
// order; and their origins.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io::internal {

/// Corner c of plate i in the file's own numbers, by the sizes that the parameter states: 3 x 4 x plates, or
/// 4 x 3 x plates as some programs write it. NaN where there are too few numbers.
[[nodiscard]] Eigen::Vector3d plate_corner(const C3dParameter* corners, std::size_t i, std::size_t c);

/// A plate whose longest side is none that a plate has (0.1 to 3 m), and would be one with its corners in mm,
/// m or cm: these are taken so, with a warning. Its origin likewise, where only then its sensors lie 1 mm to
/// 0.3 m below the surface. `metres_per_unit` is that of the points, by which corners and origin were
/// multiplied.
void settle_plate_unit(data::ForcePlate& plate, double metres_per_unit, std::vector<std::string>& warnings);

/// Corners that do not go around the edge of their plate cross over; the two that do so are exchanged, with a
/// warning. Which side is up is what other plates of the file say or, where none does, the axis of the
/// laboratory nearest to the plate's normal.
void settle_corner_order(std::span<data::ForcePlate> plates, std::vector<std::string>& warnings);

}  // namespace kinemark::io::internal
