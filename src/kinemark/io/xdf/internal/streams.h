// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/io/xdf/internal/stream_header.h"

namespace kinemark::io::internal {

/// A stream of a file. Values are kept of positions and of strings alone.
struct XdfStream {
  XdfHeader header;
  std::vector<double> time_s;                      ///< N, on the stream's clock; NaN: the file gives none
  Array<double> positions;                         ///< N x M x 3 of header.markers, in the file's unit
  std::vector<std::string> texts;                  ///< N first strings, of a stream of strings
  std::vector<std::pair<double, double>> offsets;  ///< of the clock: when, and what is to be added
};

/// All streams by their numbers, and irregularities in words.
struct XdfStreams {
  std::map<std::uint32_t, XdfStream> streams;
  std::vector<std::string> warnings;
};

/// Walk over the chunks of a whole file. Code::bad_input with the byte for a chunk that is not as the format
/// has it; a last chunk that is cut short is left out with a warning.
[[nodiscard]] Result<XdfStreams> read_xdf_streams(std::span<const std::byte> file);

}  // namespace kinemark::io::internal
