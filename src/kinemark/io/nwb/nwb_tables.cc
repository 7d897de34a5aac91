// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/nwb_tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/content_digest.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/internal/output.h"
#include "kinemark/io/nwb/internal/root.h"

namespace kinemark::io {
namespace {

std::size_t rows_of(const NwbColumn& column) { return std::max(column.texts.size(), column.numbers.size()); }

bool is_name(const std::string& name) {
  return !name.empty() && name.find('/') == std::string::npos && name != ".";
}

Status check_table(const NwbTable& table) {
  if (table.columns.empty() || rows_of(table.columns.front()) == 0)
    return fail(Code::bad_input, fmt::format("table '{}' has no rows", table.name));
  std::set<std::string> seen{"id"};
  for (const auto& column : table.columns) {
    const bool both = !column.texts.empty() && !column.numbers.empty();
    if (both || rows_of(column) != rows_of(table.columns.front()))
      return fail(Code::bad_input,
                  fmt::format("table '{}': column '{}' has {} values, others {}", table.name, column.name,
                              column.texts.size() + column.numbers.size(), rows_of(table.columns.front())));
    if (!is_name(column.name) || !seen.insert(column.name).second)
      return fail(Code::bad_input, fmt::format("table '{}': '{}' is no name of a column, or occurs twice",
                                               table.name, column.name));
  }
  return {};
}

Status check_tables(std::span<const NwbTable> tables) {
  if (tables.empty()) return fail(Code::bad_input, "there are no tables to write");
  std::set<std::string> seen{internal::kProvenanceTable, internal::kSourcesTable};
  for (const auto& table : tables) {
    if (!is_name(table.name) || !seen.insert(table.name).second)
      return fail(Code::bad_input, fmt::format("'{}' is no name of a table, or occurs twice", table.name));
    if (auto s = check_table(table); !s) return s;
  }
  return {};
}

}  // namespace

Status write_nwb_tables(const std::filesystem::path& path, std::span<const NwbTable> tables,
                        const NwbMetadata& metadata, bool force) {
  if (auto s = check_tables(tables); !s) return fail_at(path.string(), s.error());
  if (auto s = internal::check_metadata(metadata); !s) return fail_at(path.string(), s.error());
  auto file = OutputFile::create(path, force);
  if (!file) return std::unexpected(file.error());
  const internal::Quiet quiet;
  const NwbOutline outline;
  internal::Output out(file->temporary().string(), internal::identity_of(metadata, outline));
  {
    const auto module = internal::write_root(out, metadata, outline);
    for (const auto& table : tables) {
      std::vector<internal::Column> columns;
      for (const auto& [name, description, texts, numbers] : table.columns)
        columns.push_back(
            {.name = name, .description = description, .texts = texts, .numbers = numbers, .integers = {}});
      out.table(module.id(), table.name.c_str(), table.description.c_str(), columns);
    }
  }
  internal::seal(out, metadata.set);
  if (!out.close()) return fail(Code::io, fmt::format("{}: cannot be written (HDF5 failed)", path.string()));
  return file->commit();
}

}  // namespace kinemark::io
