// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <charconv>

#include "kinemark/io/nwb/internal/content_list.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/internal/reader.h"
#include "kinemark/io/set_mark.h"

namespace kinemark::io::internal {
namespace {

/// The first text of a dataset, or empty.
std::string text_at(Input& in, const char* path) {
  const Handle dataset = in.object(in.file(), path);
  const auto texts = in.texts(dataset.id());
  return texts && !texts->empty() ? texts->front() : "";
}

/// Columns of a table in the module, all of one length; empty when there is no such table.
std::vector<std::vector<std::string>> text_columns(Input& in, const char* table,
                                                   std::initializer_list<const char*> names) {
  const Handle group = in.object(in.file(), fmt::format("{}/{}", module_of(in), table));
  std::vector<std::vector<std::string>> out;
  for (const char* name : names) {
    const Handle column = in.object(group.id(), name);
    auto texts = in.texts(column.id());
    if (!texts || (!out.empty() && texts->size() != out.front().size())) return {};
    out.push_back(std::move(*texts));
  }
  return out;
}

void read_provenance(Input& in, NwbMetadata& out) {
  const auto columns = text_columns(in, kProvenanceTable, {"kind", "item", "value"});
  if (columns.empty()) return;
  for (std::size_t i = 0; i < columns[0].size(); ++i) {
    const std::string& kind = columns[0][i];
    const std::string& value = columns[2][i];
    if (kind == "software") {
      out.software = columns[1][i];
      out.version = value;
    } else if (kind == "recorder") {
      out.recorder = value;
    } else if (kind == "command") {
      out.command = value;
    } else if (kind == "option") {
      out.options.emplace_back(columns[1][i], value);
    } else if (std::uint64_t seed = 0; kind == "seed") {
      const char* end = value.data() + value.size();
      if (std::from_chars(value.data(), end, seed).ptr == end && !value.empty()) out.seed = seed;
    }
  }
}

void read_sources(Input& in, NwbMetadata& out) {
  const auto columns = text_columns(in, kSourcesTable, {"file", "xxh3"});
  if (columns.empty()) return;
  const Handle bytes = in.object(in.file(), fmt::format("{}/{}/bytes", module_of(in), kSourcesTable));
  const auto sizes = in.numbers<double>(bytes.id());
  for (std::size_t i = 0; i < columns[0].size(); ++i) {
    const double size = sizes && i < sizes->size() ? (*sizes)[i] : 0.0;
    out.sources.push_back({.file = columns[0][i],
                           .bytes = size > 0.0 && size < 9e18 ? static_cast<std::int64_t>(size) : 0,
                           .xxh3 = columns[1][i]});
  }
}

}  // namespace

NwbMetadata read_metadata(Input& in) {
  NwbMetadata out;
  out.identifier = text_at(in, "/identifier");
  out.session_description = text_at(in, "/session_description");
  out.session_start = text_at(in, "/session_start_time");
  out.created = text_at(in, "/file_create_date");
  for (std::string* date : {&out.session_start, &out.created})
    if (*date == kUnknownDate) date->clear();
  out.subject_id = text_at(in, "/general/subject/subject_id");
  out.species = text_at(in, "/general/subject/species");
  out.sex = text_at(in, "/general/subject/sex");
  out.age = text_at(in, "/general/subject/age");
  if (out.subject_id == kUnknownSubject) out.subject_id.clear();
  if (out.age == kUnknownAge) out.age.clear();
  // Others name their programs here, one pair of name and version after the other.
  const Handle generated = in.object(in.file(), "/general/was_generated_by");
  const auto software = in.texts(generated.id());
  out.software = software && !software->empty() ? software->front() : "";
  out.version = software && software->size() > 1 ? (*software)[1] : "";
  if (const auto mark = in.text_attribute(in.file(), std::string(kSetKey).c_str()))
    if (mark->size() > kSetKey.size() && mark->starts_with(kSetKey))
      out.set = mark->substr(kSetKey.size() + 1);
  read_provenance(in, out);
  read_sources(in, out);
  return out;
}

}  // namespace kinemark::io::internal
