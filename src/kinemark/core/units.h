// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace kinemark {

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;  ///< rad per degree
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;  ///< degrees per rad
inline constexpr double kStandardGravity = 9.80665;             ///< m/s^2

}  // namespace kinemark
