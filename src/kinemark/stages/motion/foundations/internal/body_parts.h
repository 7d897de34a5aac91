// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What both kinds of standing bodies share: sizes by name and side, and partners on the other side.
#pragma once

#include <numbers>
#include <string>

#include "kinemark/stages/motion/foundations/standing_body.h"

namespace kinemark::motion::internal {

inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< rad

/// Index of the size of this name and side, added where it is not there yet.
[[nodiscard]] int add_size(StandingBody& body, const std::string& name, Side side);

/// Joins markers whose names differ by their side alone.
void pair_markers(StandingBody& body);

}  // namespace kinemark::motion::internal
