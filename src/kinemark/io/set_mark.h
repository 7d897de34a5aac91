// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Files that are written together name their set: "kinemark_set=0123456789abcdef", in each format where other
// programs pass it over. docs/formats/results.md says where it stands in each.
#pragma once

#include <string>
#include <string_view>

namespace kinemark::io {

inline constexpr std::string_view kSetKey = "kinemark_set";  ///< of the line, element or attribute

/// "kinemark_set=" and the set; empty when there is none.
[[nodiscard]] inline std::string set_mark(std::string_view set) {
  return set.empty() ? std::string() : std::string(kSetKey) + "=" + std::string(set);
}

}  // namespace kinemark::io
