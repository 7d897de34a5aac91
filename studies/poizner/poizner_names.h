// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kinemark::studies {

inline constexpr const char* kPoizner = "Poizner 1986";  ///< of the figures' titles
inline constexpr double kRate_hz = 100.0;                ///< of every scenario
inline constexpr const char* kClassicInk = "#b8860b";    ///< the method of 1986
inline constexpr const char* kOursInk = "#1f5fa8";       ///< ours

}  // namespace kinemark::studies
