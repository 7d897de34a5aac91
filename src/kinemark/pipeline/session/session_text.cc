// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/session/session_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>

#include "kinemark/core/utf8.h"
#include "kinemark/io/rig/toml_fields.h"
#include "kinemark/io/rig/toml_text.h"

namespace kinemark::pipeline {
namespace {

constexpr int kFormat = 1;                            // of session.toml
constexpr std::string_view kSum = "XXH3 (";           // begins a line of MANIFEST
constexpr std::string_view kBehind = ") = ";          // between name and sum
constexpr std::size_t kDigits = 16;                   // of a sum
constexpr double kLargestWhole = 9007199254740992.0;  // 2^53, which a double counts up to

/// A file of raw/, by a name of its own: nothing that leads elsewhere.
bool is_trial_file(std::string_view file) {
  const std::filesystem::path path(file);
  return path.parent_path() == "raw" && path.extension() == ".mcap" &&
         path.filename().string().front() != '.';
}

/// A whole number of frames.
std::int64_t count(io::TomlFields& fields, std::string_view key) {
  double value = 0.0;
  fields.number(key, value, io::TomlFields::Need::required);
  if (fields.failed() || (value >= 0.0 && value <= kLargestWhole && value == std::floor(value)))
    return static_cast<std::int64_t>(value);
  fields.refuse(key, "a whole number from 0 on");
  return 0;
}

std::optional<double> perhaps(io::TomlFields& fields, const toml::table& table, std::string_view key) {
  double value = 0.0;
  fields.number(key, value);
  return table.contains(key) ? std::optional(value) : std::nullopt;
}

Result<SessionTrial> parse_trial(const toml::table& table, const std::string& name) {
  constexpr auto kRequired = io::TomlFields::Need::required;
  SessionTrial out;
  io::TomlFields fields(table, fmt::format("{}: line {}: trial", name, table.source().begin.line));
  fields.text("file", out.file, kRequired).text("source", out.source).text("started", out.started);
  fields.number("rate_hz", out.rate_hz, kRequired);
  out.frames = count(fields, "frames");
  out.dropped_by_device = count(fields, "dropped_by_device");
  out.dropped_here = count(fields, "dropped_here");
  out.clock_fast_ppm = perhaps(fields, table, "clock_fast_ppm");
  out.clock_fast_sd_ppm = perhaps(fields, table, "clock_fast_sd_ppm");
  if (!fields.failed() && !is_trial_file(out.file))
    fields.refuse("file", "a recording in raw/, raw/NAME.mcap");
  if (auto s = fields.finish(); !s) return std::unexpected(s.error());
  return out;
}

toml::table table_of(const SessionTrial& trial) {
  toml::table out{{"file", trial.file},
                  {"source", trial.source},
                  {"started", trial.started},
                  {"rate_hz", trial.rate_hz},
                  {"frames", trial.frames},
                  {"dropped_by_device", trial.dropped_by_device},
                  {"dropped_here", trial.dropped_here}};
  if (trial.clock_fast_ppm) out.insert("clock_fast_ppm", *trial.clock_fast_ppm);
  if (trial.clock_fast_sd_ppm) out.insert("clock_fast_sd_ppm", *trial.clock_fast_sd_ppm);
  return out;
}

std::unexpected<Error> bad_line(const std::string& name, int line, std::string_view text) {
  return fail(Code::bad_input,
              fmt::format("{}: line {}: '{}' is no checksum; need XXH3 (raw/NAME.mcap) = and {} digits", name,
                          line, printable(text, 60), kDigits));
}

Result<ManifestEntry> parse_entry(std::string_view line, const std::string& name, int number) {
  const auto behind = line.rfind(kBehind);
  if (!line.starts_with(kSum) || behind == std::string_view::npos || behind < kSum.size())
    return bad_line(name, number, line);
  ManifestEntry out{std::string(line.substr(kSum.size(), behind - kSum.size())),
                    std::string(line.substr(behind + kBehind.size()))};
  const bool digits =
      out.hex.size() == kDigits && out.hex.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (!digits || !is_trial_file(out.file)) return bad_line(name, number, line);
  return out;
}

}  // namespace

std::string session_text(const SessionFile& session) {
  toml::table out{{"format", kFormat}, {"subject", session.subject}};
  if (session.has_rig) out.insert("rig", "rig.toml");
  toml::array trials;
  for (const auto& trial : session.trials) trials.push_back(table_of(trial));
  if (!trials.empty()) out.insert("trial", std::move(trials));
  std::ostringstream text;
  text << "# A session of kinemark: docs/formats/session.md. Written by `kinemark acquire`.\n"
       << toml::toml_formatter(out, toml::format_flags::none) << "\n";
  return text.str();
}

Result<SessionFile> parse_session(std::string_view text, const std::string& name) {
  const auto table = io::parse_toml(text, name);
  if (!table) return std::unexpected(table.error());
  SessionFile out;
  io::TomlFields fields(*table, name);
  int format = 0;
  std::string rig;
  fields.integer("format", format, io::TomlFields::Need::required).text("subject", out.subject);
  fields.text("rig", rig);
  if (!fields.failed() && format != kFormat) fields.refuse("format", fmt::format("{}", kFormat));
  if (!fields.failed() && !rig.empty() && rig != "rig.toml") fields.refuse("rig", "\"rig.toml\"");
  out.has_rig = !rig.empty();
  const toml::array* trials = fields.tables("trial");
  if (auto s = fields.finish(); !s) return std::unexpected(s.error());
  if (trials == nullptr) return out;
  for (const auto& node : *trials) {
    auto trial = parse_trial(*node.as_table(), name);
    if (!trial) return std::unexpected(trial.error());
    if (std::ranges::find(out.trials, trial->file, &SessionTrial::file) != out.trials.end())
      return fail(Code::bad_input, fmt::format("{}: {} stands there twice; need each once", name,
                                               printable(trial->file, 200)));
    out.trials.push_back(std::move(*trial));
  }
  return out;
}

std::string manifest_text(const std::vector<ManifestEntry>& entries) {
  std::string out;
  for (const auto& entry : entries) out += fmt::format("{}{}{}{}\n", kSum, entry.file, kBehind, entry.hex);
  return out;
}

Result<std::vector<ManifestEntry>> parse_manifest(std::string_view text, const std::string& name) {
  std::vector<ManifestEntry> out;
  std::set<std::string> files;
  for (int number = 1; !text.empty(); ++number) {
    const auto line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    auto entry = parse_entry(line, name, number);
    if (!entry) return std::unexpected(entry.error());
    if (!files.insert(entry->file).second)
      return fail(Code::bad_input, fmt::format("{}: line {}: {} stands there twice; need each once", name,
                                               number, printable(entry->file, 200)));
    out.push_back(std::move(*entry));
  }
  return out;
}

}  // namespace kinemark::pipeline
