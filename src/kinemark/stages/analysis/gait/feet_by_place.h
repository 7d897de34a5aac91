// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Markers of feet by where they are, for recordings whose names do not tell.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "kinemark/data/trajectories.h"

namespace kinemark::analysis {

/// Two markers of each foot; the same twice where one alone was found.
struct FeetByPlace {
  std::array<std::array<std::int64_t, 2>, 2> feet{};  ///< left, right: rear, front
  bool sides_known = false;                           ///< names tell left from right
};

/// Names that differ in their side alone, both among the lowest 13 % of the body (3 cm more): of these, the
/// two that keep the largest constant distance from 70 to 350 mm; the rear one is that which rises more.
/// Where no names pair, the lowest markers in two groups that keep their distances.
///
/// @param among  markers of one person
/// @return nothing where the lowest markers are no two feet
[[nodiscard]] std::optional<FeetByPlace> find_feet_by_place(const data::Trajectories& markers,
                                                            std::span<const std::int64_t> among);

}  // namespace kinemark::analysis
