// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Missing numbers are NaN; a state stored beside them gives the reason.
#pragma once

#include <limits>

namespace kinemark {

/// A number that is missing or not determined.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace kinemark
