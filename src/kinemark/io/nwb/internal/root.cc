// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/root.h"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>

#include "kinemark/core/random.h"
#include "kinemark/io/nwb/internal/content_list.h"
#include "kinemark/io/nwb/internal/names.h"

namespace kinemark::io::internal {
namespace {

/// YYYY-MM-DDThh:mm:ss[.fraction] and Z, +hh:mm or -hh:mm.
bool is_date(std::string_view text) {
  const auto take = [&](std::string_view pattern) {
    if (text.size() < pattern.size()) return false;
    const auto fits = [](char wanted, char c) { return wanted == '0' ? c >= '0' && c <= '9' : c == wanted; };
    if (!std::ranges::equal(pattern, text.substr(0, pattern.size()), fits)) return false;
    text.remove_prefix(pattern.size());
    return true;
  };
  if (!take("0000-00-00T00:00:00")) return false;
  if (take("."))
    while (take("0")) continue;
  return text == "Z" || ((take("+00:00") || take("-00:00")) && text.empty());
}

std::string fallback(const std::string& text, const char* otherwise) {
  return text.empty() ? otherwise : text;
}

void write_provenance(Output& out, hid_t module, const NwbMetadata& m) {
  Column kind{.name = "kind", .description = "software, recorder, command, seed or option"};
  Column name{.name = "item", .description = "what is said"};
  Column value{.name = "value", .description = "its value"};
  const auto row = [&](const char* k, const std::string& n, const std::string& v) {
    kind.texts.emplace_back(k);
    name.texts.push_back(n);
    value.texts.push_back(v);
  };
  row("software", m.software, m.version);
  if (!m.recorder.empty()) row("recorder", "recorder", m.recorder);
  if (!m.command.empty()) row("command", "command", m.command);
  if (m.seed) row("seed", "seed", fmt::format("{}", *m.seed));
  for (const auto& [option, setting] : m.options) row("option", option, setting);
  out.table(module, kProvenanceTable, "how this file was made", {kind, name, value});
  if (m.sources.empty()) return;
  Column file{.name = "file", .description = "name of a file that the samples were made from"};
  Column bytes{.name = "bytes", .description = "its size"};
  Column hash{.name = "xxh3", .description = "its XXH3 checksum, 64 bits, hexadecimal"};
  for (const NwbSource& source : m.sources) {
    file.texts.push_back(source.file);
    bytes.integers.push_back(source.bytes);
    hash.texts.push_back(source.xxh3);
  }
  out.table(module, kSourcesTable, "files that the samples were made from", {file, bytes, hash});
}

}  // namespace

std::string identity_of(const NwbMetadata& m, const NwbOutline& outline) {
  if (!m.identifier.empty()) return m.identifier;
  std::string all = fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{} {} {}\n", m.session_description, m.session_start,
                                m.created, m.subject_id, m.command, m.version, outline.time.rate_hz,
                                outline.time.t0_s, outline.time.frames);
  for (const std::string& name : outline.names) all += name + "\n";
  for (const NwbSource& s : m.sources) all += fmt::format("{} {} {}\n", s.file, s.bytes, s.xxh3);
  for (const auto& [option, value] : m.options) all += fmt::format("{}={}\n", option, value);
  if (m.seed) all += fmt::format("{}", *m.seed);
  std::uint64_t hash = all.size();
  for (const char c : all) hash = mix64(hash ^ static_cast<unsigned char>(c)) + 0x9E3779B97F4A7C15ULL;
  return fmt::format("kinemark-{:016x}", hash);
}

Status check_metadata(const NwbMetadata& m) {
  for (const std::string* date : {&m.session_start, &m.created})
    if (!date->empty() && !is_date(*date))
      return fail(
          Code::bad_input,
          fmt::format("'{}' is not a date in the form of NWB; expected 2026-11-21T14:05:00+00:00", *date));
  if (!m.sex.empty() && m.sex != "F" && m.sex != "M" && m.sex != "U" && m.sex != "O")
    return fail(Code::bad_input, fmt::format("'{}' is not a sex that NWB knows; need F, M, U or O", m.sex));
  return {};
}

Handle write_root(Output& out, const NwbMetadata& m, const NwbOutline& outline, const std::string& room) {
  const hid_t file = out.file();
  out.declare(file, "NWBFile");
  out.attribute(file, "nwb_version", "2.9.0");
  const std::string start = fallback(m.session_start, kUnknownDate);
  out.text(file, "identifier", identity_of(m, outline));
  out.text(file, "session_description", fallback(m.session_description, "marker trajectories"));
  out.text(file, "session_start_time", start);
  out.text(file, "timestamps_reference_time", start);
  out.texts(file, "file_create_date", {fallback(m.created, start.c_str())});
  for (const char* name : {"acquisition", "analysis"}) out.group(file, name);
  const Handle stimulus = out.group(file, "stimulus");
  for (const char* name : {"presentation", "templates"}) out.group(stimulus.id(), name);

  const Handle general = out.group(file, "general");
  out.texts(general.id(), "was_generated_by", {m.software, fallback(m.version, "unknown")}, 2);
  // NWB requires a subject, even an unknown one.
  const Handle subject = out.group(general.id(), "subject", "Subject");
  out.text(subject.id(), "subject_id", fallback(m.subject_id, kUnknownSubject));
  out.text(subject.id(), "description", "subject of the recording");
  for (const auto& [name, value] : {std::pair("species", m.species),
                                    {"sex", fallback(m.sex, "U")},
                                    {"age", fallback(m.age, kUnknownAge)}})
    if (!value.empty()) out.text(subject.id(), name, value);
  out.group(file, "processing");
  Handle module = out.group(file, room.c_str(), "ProcessingModule");
  if (room != kModule) out.attribute(file, kModuleAttribute, room);
  out.attribute(module.id(), "description", "marker positions, their quality and what was made of them");
  write_provenance(out, module.id(), m);
  return module;
}

}  // namespace kinemark::io::internal
