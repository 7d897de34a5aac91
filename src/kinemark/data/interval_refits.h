// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How many simulated recordings an interval needs.
#pragma once

#include <cstdint>

#include "kinemark/core/result.h"

namespace kinemark::data {

/// Levels of intervals go up to it: it needs 19999 refits.
inline constexpr double kMostLevel = 0.9999;

/// The least number S of refits whose smallest and largest deviations are the ends of an interval of the
/// level: (S + 1) (1 - level) / 2 >= 1. 39 of 0.95, 199 of 0.99. 0 for a level that is none.
[[nodiscard]] std::int64_t least_refits(double level);

/// Code::usage unless the level is above 0.5 and at most kMostLevel, and the refits are 0 (no intervals) or
/// as many as it needs, 39 at least.
[[nodiscard]] Status check_interval_refits(std::int64_t refits, double level);

}  // namespace kinemark::data
