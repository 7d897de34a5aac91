// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/orientation_table.h"

#include <fmt/core.h>

#include <string>
#include <utility>

#include "kinemark/io/file.h"
#include "kinemark/io/text/internal/any_table.h"
#include "kinemark/io/text/internal/quaternion_rows.h"
#include "kinemark/io/text/internal/table_header.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

Result<data::Orientations> orientations_of(data::Table table) {
  internal::QuaternionRows rows;
  for (std::size_t c = 0; c + 3 < table.columns.size(); c += 4) {
    const auto& column = table.columns[c];
    rows.names.push_back(column.substr(0, column.size() - 2));  // "_1"
  }
  rows.time_s.assign(table.time_s.begin(), table.time_s.end());
  rows.values = std::move(table.values);
  rows.warnings = std::move(table.warnings);
  rows.place = [](std::size_t row) { return fmt::format("row {}", row + 1); };
  return internal::settle_quaternions(std::move(rows));
}

}  // namespace

Result<data::Orientations> parse_orientations(std::string_view text, std::string_view name) {
  auto table = internal::parse_table(text, name, true);
  if (!table) return std::unexpected(table.error());
  auto out = orientations_of(std::move(*table));
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
