// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iterator>
#include <string>

#include "kinemark/core/check.h"
#include "kinemark/core/number.h"
#include "kinemark/io/file.h"
#include "kinemark/io/seal.h"
#include "kinemark/io/set_mark.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/table_header.h"
#include "kinemark/io/text/table_file.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kFlushBytes = 1 << 20;

bool fits_a_line(std::string_view text) { return text.find_first_of("\r\n") == std::string_view::npos; }

/// Characters that would break the format.
Status check_texts(const data::Table& table) {
  if (!fits_a_line(table.name)) return fail(Code::bad_input, "the table's name holds a line end");
  for (const auto& [key, value] : table.header)
    if (!fits_a_line(key) || !fits_a_line(value) || internal::lower(trim(value)) == "endheader")
      return fail(Code::bad_input, "a header line holds a line end or the word endheader");
  for (const std::string& column : table.columns)
    if (column.empty() || column.find_first_of("\t\r\n") != std::string::npos)
      return fail(Code::bad_input, fmt::format("column label '{}' is empty or holds a tab or line end",
                                               internal::excerpt(column)));
  return {};
}

std::string header_text(const std::filesystem::path& path, const data::Table& table,
                        const TableWriteOptions& options) {
  const int version = options.version;
  std::string out = (table.name.empty() ? path.stem().string() : table.name) + "\n";
  if (version == 1)
    out += fmt::format("version=1\nnRows={}\nnColumns={}\n", table.rows(), table.columns.size() + 1);
  if (!options.set.empty()) out += fmt::format("{}\n{}={}\n", set_mark(options.set), kSumKey, kNoSum);
  // A SIMM header without a statement means degrees; without the header the new file would mean radians.
  if (table.degrees_stated || angles_are_degrees(table))
    out += angles_are_degrees(table) ? "inDegrees=yes\n" : "inDegrees=no\n";
  for (const auto& [key, value] : table.header) {
    // A sentence about degrees may be older than the values; the inDegrees line is right.
    if (internal::is_written_by_us(key) || internal::lower(value).starts_with("angles are in ")) continue;
    out += key.empty() ? value : key + "=" + value;
    out += '\n';
  }
  if (version == 3) out += "DataType=double\nversion=3\n";
  out += "endheader\ntime";
  for (const std::string& column : table.columns) out += "\t" + column;
  return out + "\n";
}

}  // namespace

Status write_table(const std::filesystem::path& path, const data::Table& table,
                   const TableWriteOptions& options) {
  check(options.version == 1 || options.version == 3, "TableWriteOptions::version is neither 1 nor 3");
  check(options.decimals >= -1 && options.decimals <= 17,
        "TableWriteOptions::decimals lies outside -1 to 17");
  if (auto status = table.validate(); !status) return fail_at(path.string(), status.error());
  if (auto status = check_texts(table); !status) return fail_at(path.string(), status.error());
  auto file = OutputFile::create(path, options.force);
  if (!file) return std::unexpected(file.error());
  const auto header = header_text(path, table, options);
  if (auto status = options.set.empty() ? file->write(header) : file->write_sealed(header); !status)
    return status;
  fmt::memory_buffer out;
  const auto end = std::back_inserter(out);
  const auto put = [&](double value) {
    if (options.decimals < 0)
      out.append(format_number(value));
    else
      fmt::format_to(end, "{:.{}f}", value, options.decimals);
  };
  for (std::int64_t row = 0; row < table.rows(); ++row) {
    put(table.time_s[static_cast<std::size_t>(row)]);
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
      out.push_back('\t');
      put(table(row, static_cast<std::int64_t>(column)));
    }
    out.push_back('\n');
    if (out.size() < kFlushBytes && row + 1 < table.rows()) continue;
    if (auto status = file->write(std::string_view(out.data(), out.size())); !status) return status;
    out.clear();
  }
  return file->commit();
}

}  // namespace kinemark::io
