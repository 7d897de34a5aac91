// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/orientation_table.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/io/file.h"
#include "kinemark/io/text/internal/any_table.h"
#include "kinemark/io/text/internal/table_header.h"
#include "kinemark/io/text/internal/time_column.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

constexpr std::int64_t kNumbers = 4;      // of a quaternion
constexpr double kLengthTolerance = 0.1;  // files round to a few digits; more is no rotation

Result<data::Orientations> orientations_of(const data::Table& table) {
  data::Orientations out;
  out.warnings = table.warnings;
  const auto sensors = static_cast<std::int64_t>(table.columns.size()) / kNumbers;
  if (sensors == 0 || table.rows() == 0)
    return fail(Code::bad_input, "holds no orientation; expected a column of quaternions for each sensor");
  for (std::int64_t s = 0; s < sensors; ++s) {
    const auto& column = table.columns[at(kNumbers * s)];
    out.names.push_back(column.substr(0, column.size() - 2));  // "_1"
  }
  const auto place = [](std::size_t row) { return fmt::format("row {}", row + 1); };
  const auto clock = internal::even_clock({.time_s = table.time_s,
                                           .resolution_s = 0.0,
                                           .stated = {},
                                           .most_frames = 2 * table.rows() + 1'000'000 / sensors,
                                           .place = place},
                                          out.warnings);
  if (!clock) return std::unexpected(clock.error());
  // Such a table need not state a rate.
  std::erase_if(out.warnings,
                [](const std::string& warning) { return warning.starts_with("header gives no rate"); });
  out.time = clock->time;
  out.quaternion.assign(at(kNumbers * out.frames() * sensors), kNaN);
  std::vector<std::int64_t> zeros(at(sensors));
  for (std::int64_t r = 0; r < table.rows(); ++r) {
    const auto f = clock->frame.empty() ? r : clock->frame[at(r)];
    for (std::int64_t s = 0; s < sensors; ++s) {
      std::array<double, 4> q{};
      double squares = 0.0;
      for (std::int64_t k = 0; k < kNumbers; ++k) {
        q[at(k)] = table(r, kNumbers * s + k);
        squares += q[at(k)] * q[at(k)];
      }
      const double length = std::sqrt(squares);
      if (length == 0.0) ++zeros[at(s)];
      if (!(length > 0.0)) continue;
      if (!(std::abs(length - 1.0) < kLengthTolerance))
        return fail(Code::bad_input, fmt::format("row {}, '{}': a quaternion of length {:.3g}; expected 1",
                                                 r + 1, out.names[at(s)], length));
      for (std::int64_t k = 0; k < kNumbers; ++k)
        out.quaternion[at(kNumbers * (f * sensors + s) + k)] = q[at(k)] / length;
    }
  }
  for (std::int64_t s = 0; s < sensors; ++s)
    if (zeros[at(s)] > 0)
      out.warnings.push_back(fmt::format("sensor '{}': quaternions of zeros in {} rows, taken as missing",
                                         out.names[at(s)], zeros[at(s)]));
  if (auto s = out.validate(); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace

Result<data::Orientations> parse_orientations(std::string_view text, std::string_view name) {
  const auto table = internal::parse_table(text, name, true);
  if (!table) return std::unexpected(table.error());
  auto out = orientations_of(*table);
  if (!out) return fail_at(name, out.error());
  return out;
}

Result<data::Orientations> read_orientations(const std::filesystem::path& path) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_orientations(*text, path.string());
}

Result<bool> holds_orientations(const std::filesystem::path& path) {
  const auto begin = read_begin(path);
  if (!begin) return std::unexpected(begin.error());
  internal::Lines lines(*begin);
  const auto header = internal::parse_table_header(lines);
  if (!header) return fail_at(path.string(), header.error());
  return header->is_orientations;
}

}  // namespace kinemark::io
