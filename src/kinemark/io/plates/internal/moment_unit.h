// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The unit of a plate's moments, held against the plate that the force must lie on.
#pragma once

#include <Eigen/Core>
#include <span>

#include "kinemark/io/plates/internal/plate_wrench.h"

namespace kinemark::io::internal {

constexpr double kSurelyLoaded = 100.0;  // N; noise and drift of plates stay below it

/// Whether a point, from the middle of the surface in the plate's axes, lies on it or a little beside it, m.
[[nodiscard]] bool is_on_plate(const Eigen::Vector2d& point, const Eigen::Vector2d& half_size);

/// Whether moments of one plate are those of `smaller` or of `larger`, which are the same a thousand times:
/// true where only the other of the two has the loaded frames where no foot can be. Of the smaller, these lie
/// metres off by `larger` and on the plate by `smaller`, half of them 20 mm or more from its middle
/// (`is_smaller`); of the larger, they lie on the plate by `larger`, 20 mm or more from the middle of the
/// sensors, where `smaller` has all of them. False with fewer than 5 loaded frames.
[[nodiscard]] bool is_a_thousandth(std::span<const Vector6> larger, std::span<const Vector6> smaller,
                                   bool is_smaller, const Eigen::Vector2d& half_size);

}  // namespace kinemark::io::internal
