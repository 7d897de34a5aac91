// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace kinemark::studies {

inline constexpr const char* kMacaque = "Macaque report";  ///< of the figures' titles
inline constexpr const char* kReportInk = "#b8860b";       ///< the report's method
inline constexpr const char* kScoreInk = "#2e8b57";        ///< SCoRE
inline constexpr const char* kOursInk = "#1f5fa8";         ///< ours
inline constexpr const char* kBoundInk = "#9a9a9a";        ///< the Cramer-Rao bound
/// LEDs of the upper arm and of the forearm.
inline constexpr std::array<const char*, 2> kSegmentInks{"#d2691e", "#7b3fa0"};

}  // namespace kinemark::studies
