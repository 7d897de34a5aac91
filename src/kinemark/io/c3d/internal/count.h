// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

namespace kinemark::io::internal {

/// A count that a file gives as any number, NaN included.
inline std::size_t bounded_count(double value, std::size_t most) {
  return value >= 0.0 ? static_cast<std::size_t>(std::min(value, static_cast<double>(most))) : 0;
}

}  // namespace kinemark::io::internal
