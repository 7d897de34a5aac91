// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Names of a file that gives one name to several things.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace kinemark {

/// Which names stood more than once.
struct RepeatedNames {
  std::size_t changed = 0;  ///< names that got a number
  std::string example;      ///< the first of them as it was; empty when there is none
};

/// Gives every name that stood before a number that makes it its own: the second "A" becomes "A_2", or "A_3"
/// where "A_2" is taken. The first of equal names keeps its name, and so does every name that stands once.
/// O(N log N) for N names, with many equal ones too.
RepeatedNames make_distinct(std::span<std::string> names);

}  // namespace kinemark
