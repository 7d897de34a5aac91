// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts Eigen's signed indices to the unsigned ones of the standard containers.
#pragma once

#include <concepts>
#include <cstddef>

namespace kinemark {

/// @param i  at least 0
/// @return   `i` as the standard containers take it: `values[at(i)]`. Not checked.
template <std::integral Integer>
[[nodiscard]] constexpr std::size_t at(Integer i) {
  return static_cast<std::size_t>(i);
}

}  // namespace kinemark
