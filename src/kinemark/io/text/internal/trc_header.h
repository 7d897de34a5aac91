// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/length_unit.h"
#include "kinemark/core/result.h"
#include "kinemark/io/text/internal/cells.h"

namespace kinemark::io::internal {

/// The lines of a TRC file before its rows.
struct TrcHeader {
  std::vector<double> rates_hz;  ///< DataRate, CameraRate, OrigDataRate, as far as they are numbers
  std::optional<double> frames;  ///< NumFrames as written
  std::optional<double> markers;
  std::string units;                       ///< as written, empty when absent
  std::int64_t units_line = 0;             ///< where it stands
  double units_per_metre = 1000.0;         ///< coordinates of the file are divided by it
  std::vector<LengthUnitName> units_like;  ///< what an unknown unit may be; units_per_metre is 1 then
  Separator separator = Separator::tab;
  std::vector<std::string> names;    ///< M marker names, unique
  std::vector<std::int32_t> marker;  ///< index of the marker in cells 2 + 3 k to 4 + 3 k, or -1: not named
  /// Which of x, y, z the three cells of each slot of `marker` hold, as the line of labels says; empty: in
  /// this order.
  std::vector<std::array<std::uint8_t, 3>> axes;
  std::vector<std::string> warnings;
};

/// Read up to the last line before the rows, blank lines included. Errors carry the line, not the file.
[[nodiscard]] Result<TrcHeader> parse_trc_header(Lines& lines);

}  // namespace kinemark::io::internal
