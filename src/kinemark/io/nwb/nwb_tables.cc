// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/nwb_tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/carry.h"
#include "kinemark/io/nwb/internal/content_digest.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/internal/output.h"
#include "kinemark/io/nwb/internal/root.h"
#include "kinemark/io/temporary.h"

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

/// The module of a copy that tables go into: others may have one of its name.
std::string room_for_tables(const data::Beside& beside, const std::string& name) {
  const auto taken = [&](const std::string& module) {
    return std::ranges::any_of(beside.objects, [&](const data::BesideObject& object) {
      return object.path == module || object.path.starts_with(module + "/");
    });
  };
  std::string out = "/processing/" + name;
  for (int number = 2; taken(out); ++number) out = fmt::format("/processing/{}_{}", name, number);
  return out;
}

void write_all(internal::Output& out, std::span<const NwbTable> tables, const NwbMetadata& metadata,
               const std::string& room) {
  {
    const auto module = internal::write_root(out, metadata, {}, room);
    for (const auto& table : tables) {
      std::vector<internal::Column> columns;
      for (const auto& [name, description, texts, numbers] : table.columns)
        columns.push_back(
            {.name = name, .description = description, .texts = texts, .numbers = numbers, .integers = {}});
      out.table(module.id(), table.name.c_str(), table.description.c_str(), columns);
    }
  }
  internal::seal_whole(out, metadata.set);
}

/// The tables as a file of their own, whatever its name.
Status write_alone(const std::filesystem::path& file, const std::filesystem::path& path,
                   std::span<const NwbTable> tables, const NwbMetadata& metadata, const std::string& room) {
  const internal::Quiet quiet;
  internal::Output out(file.string(), internal::identity_of(metadata, {}));
  write_all(out, tables, metadata, room);
  return out.close() ? Status()
                     : fail(Code::io, fmt::format("{}: cannot be written (HDF5 failed)", path.string()));
}

}  // namespace

Status write_nwb_tables(const std::filesystem::path& path, std::span<const NwbTable> tables,
                        const NwbMetadata& metadata, bool force, const data::Beside* beside,
                        const std::string& module) {
  if (auto s = check_tables(tables); !s) return fail_at(path.string(), s.error());
  if (auto s = internal::check_metadata(metadata); !s) return fail_at(path.string(), s.error());
  auto file = OutputFile::create(path, force);
  if (!file) return std::unexpected(file.error());
  if (beside == nullptr || beside->file.empty()) {
    if (auto s = write_alone(file->temporary(), path, tables, metadata, internal::kModule); !s) return s;
    return file->commit();
  }
  const auto fresh = Temporary::file_for(path);
  if (!fresh) return std::unexpected(fresh.error());
  if (auto s = write_alone(fresh->path(), path, tables, metadata, room_for_tables(*beside, module)); !s)
    return s;
  if (auto s = internal::carry(beside->file, fresh->path(), *file, path.string()); !s) return s;
  return file->commit();
}

}  // namespace kinemark::io
