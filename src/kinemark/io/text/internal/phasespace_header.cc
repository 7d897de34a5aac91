// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// PhaseSpace's text has no header: its first row tells how many markers there are.
#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "kinemark/io/text/internal/vendor_headers.h"

namespace kinemark::io::internal {
namespace {

using Kind = MarkerColumns::Kind;

constexpr std::ptrdiff_t kCellsPerMarker = 4;

}  // namespace

Result<VendorHeader> parse_phasespace_header(Lines& lines, data::Trial& trial) {
  Lines ahead = lines;  // the first row is a row of data
  std::string_view line;
  if (!ahead.next(line)) return fail(Code::bad_input, "the file is empty; expected a text of PhaseSpace");
  if (auto s = check_header_line(line, ahead.number()); !s) return std::unexpected(s.error());
  const auto cells = 1 + std::ranges::count(line, ',');
  if (cells < 1 + kCellsPerMarker || (cells - 1) % kCellsPerMarker != 0)
    return fail(
        Code::bad_input,
        fmt::format("line {}: holds {} cells; expected a time, and of each marker its condition, x, y "
                    "and z",
                    ahead.number(), cells));
  VendorHeader out;
  out.columns.separator = ',';
  out.columns.columns.push_back({.kind = Kind::time});
  const auto markers = static_cast<std::int32_t>((cells - 1) / kCellsPerMarker);
  for (std::int32_t m = 0; m < markers; ++m) {
    out.columns.names.push_back(fmt::format("M{:03}", m));
    out.columns.columns.push_back({.kind = Kind::condition, .marker = m});
    for (std::int8_t axis = 0; axis < 3; ++axis)
      out.columns.columns.push_back({.kind = Kind::coordinate, .marker = m, .axis = axis});
  }
  trial.software = "PhaseSpace";
  trial.warnings.push_back(fmt::format(
      "the text names no markers and no unit: its markers are called {} to {}, and millimetres are taken",
      out.columns.names.front(), out.columns.names.back()));
  return out;
}

}  // namespace kinemark::io::internal
