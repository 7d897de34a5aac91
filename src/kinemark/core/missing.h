// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// How a number says that it is missing: by NaN, with a state beside it that says why.
#pragma once

#include <limits>

namespace kinemark {

/// A number that is missing or not determined.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace kinemark
