// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <string>

#include "kinemark/io/matlab/internal/mat_build.h"
#include "kinemark/io/matlab/internal/mat_file.h"
#include "kinemark/io/matlab/mat.h"

namespace kinemark::io {
namespace {

using internal::mat_number;
using internal::mat_numbers;
using internal::mat_text;
using internal::mat_texts;

constexpr double kTableVersion = 1.0;  // of this struct

std::string variable(const data::Table& table, bool degrees) {
  const std::int64_t rows = table.rows(), width = std::ssize(table.columns);
  std::vector<std::string> keys, values;
  for (const auto& [key, value] : table.header) {
    keys.push_back(key);
    values.push_back(value);
  }
  return internal::mat_struct(
      {{"version", mat_number(kTableVersion)},
       {"name", mat_text(table.name)},
       {"in_degrees", mat_number(degrees ? 1.0 : 0.0)},
       {"header_keys", mat_texts(keys)},
       {"header_values", mat_texts(values)},
       {"time", mat_numbers(table.time_s, {rows, 1})},
       {"labels", mat_texts(table.columns)},
       {"data", mat_numbers(internal::to_columns(std::span<const double>(table.values), rows, width, 1),
                            {rows, width})}},
      "table");
}

}  // namespace

Status write_mat(const std::filesystem::path& path, const data::Table& table, bool degrees,
                 const MatWriteOptions& options) {
  if (auto s = table.validate(); !s) return fail_at(path.string(), s.error());
  const auto too_large = [&] {
    return fail(Code::not_supported,
                fmt::format("{}: the table needs more than the 2 GB that a variable of a MAT file can have",
                            path.string()));
  };
  if (8 * (table.values.size() + table.time_s.size()) > internal::kMostVariableBytes) return too_large();
  const std::string bytes = variable(table, degrees);
  if (bytes.size() > internal::kMostVariableBytes) return too_large();
  return internal::write_mat_file(path, bytes, options);
}

}  // namespace kinemark::io
