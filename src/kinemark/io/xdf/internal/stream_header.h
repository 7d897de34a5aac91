// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io::internal {

/// How the values of a stream lie in the file.
enum class XdfFormat : std::uint8_t { float32, double64, int8, int16, int32, int64, string };

/// Bytes of a value; 0 of strings.
[[nodiscard]] std::size_t size_of(XdfFormat format);

/// A marker of a stream, by its channels.
struct XdfMarker {
  std::string name;                      ///< of the marker
  std::array<std::size_t, 3> channel{};  ///< of x, y, z
  std::string unit;                      ///< as the file says; empty: it does not
};

/// What the header of a stream says.
struct XdfHeader {
  std::string name, type;                 ///< "OptiTrack", "MoCap"
  std::size_t channels = 0;               ///< 1 to a million
  double rate_hz = 0.0;                   ///< nominal; 0: none
  XdfFormat format = XdfFormat::float32;  ///< of all channels
  std::vector<XdfMarker> markers;         ///< triples of positions
  std::size_t other_channels = 0;         ///< that are no part of a triple
};

/// The XML of a stream's header. Positions are channels of type PositionX, PositionY, PositionZ, or in a
/// stream of type MoCap those whose label ends in x, y, z; a marker is named by <marker> or its label.
[[nodiscard]] Result<XdfHeader> parse_xdf_header(std::string_view xml);

}  // namespace kinemark::io::internal
