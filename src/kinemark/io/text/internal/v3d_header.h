// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/text/internal/cells.h"

namespace kinemark::io::internal {

/// The five rows of a Visual3D text export before its data.
struct V3dHeader {
  /// Where the number of one column goes.
  struct Slot {
    enum class Kind : std::uint8_t { unread, point, angle };
    Kind kind = Kind::unread;
    std::int32_t signal = 0;  ///< among those of its kind
    std::int32_t axis = 0;    ///< 0 to 2
  };
  std::vector<std::string> points, angles;  ///< names in order, each unique
  std::vector<Slot> slots;                  ///< one per column after ITEM
  std::string recorded_as;                  ///< the first source file named
  std::vector<std::string> warnings;
};

/// Errors carry the line, not the file.
[[nodiscard]] Result<V3dHeader> parse_v3d_header(Lines& lines);

}  // namespace kinemark::io::internal
