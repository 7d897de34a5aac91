// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace kinemark::io::internal {

/// Which columns of a table of one line a sample are what, by labels of other people: "Frame,Name,X,Y,Z
/// (mm)".
struct LongLabels {
  std::optional<std::size_t> frame, time, marker;
  std::array<std::optional<std::size_t>, 3> coordinate;  ///< x, y, z
  std::string unit;                                      ///< of the coordinates; empty: the labels state none
  double units_per_second = 1.0;

  /// Whether all is there that a recording needs: frames may be counted by their times.
  [[nodiscard]] bool is_whole() const {
    return time && marker && coordinate[0] && coordinate[1] && coordinate[2];
  }
};

/// The first column of each kind.
[[nodiscard]] LongLabels long_labels(const std::vector<std::string>& cells);

}  // namespace kinemark::io::internal
