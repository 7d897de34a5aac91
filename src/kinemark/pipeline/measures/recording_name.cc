// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/recording_name.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string_view>
#include <system_error>

#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/files/input_list.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/table_cell.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kShown = 60;
// Columns of the tables of measures, events and cycles.
constexpr std::array<std::string_view, 34> kOwnColumns{"file",
                                                       "participant",
                                                       "session",
                                                       "trial",
                                                       "subject",
                                                       "context",
                                                       "region",
                                                       "cycle",
                                                       "start_s",
                                                       "end_s",
                                                       "measure",
                                                       "value",
                                                       "unit",
                                                       "low",
                                                       "high",
                                                       "level",
                                                       "interval",
                                                       "approximate",
                                                       "sd",
                                                       "uncorrected",
                                                       "share_not_measured",
                                                       "method",
                                                       "remark",
                                                       "label",
                                                       "time_s",
                                                       "frame",
                                                       "sd_s",
                                                       "source",
                                                       "curve",
                                                       "percent",
                                                       "sd_between",
                                                       "participant_id",
                                                       "session_id",
                                                       "trial_id"};

// KEY-LABEL, of letters and digits.
bool is_entity(std::string_view part) {
  const auto dash = part.find('-');
  const auto plain = [](std::string_view text) {
    return !text.empty() &&
           std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) != 0 || c == '+'; });
  };
  return dash != std::string_view::npos && plain(part.substr(0, dash)) && plain(part.substr(dash + 1));
}

std::vector<std::string> parts_of(const std::string& stem) {
  std::vector<std::string> out;
  for (std::size_t begin = 0; begin <= stem.size();) {
    const auto end = std::min(stem.find('_', begin), stem.size());
    out.push_back(stem.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

// The folder nearest to the file that is called so; empty: none.
std::string folder_called(const fs::path& path, std::string_view prefix) {
  std::string found;
  for (const auto& part : path.parent_path())
    if (part.string().starts_with(prefix) && is_entity(part.string())) found = part.string();
  return found;
}

std::string known(const std::string& cell) { return cell == "n/a" ? std::string() : cell; }

// With or without its prefix: "sub-01" is "01".
bool is_same(std::string_view a, std::string_view b, std::string_view prefix) {
  if (a.starts_with(prefix)) a.remove_prefix(prefix.size());
  if (b.starts_with(prefix)) b.remove_prefix(prefix.size());
  return a == b;
}

std::int64_t find_one_of(const io::TidyTable& table, std::initializer_list<std::string_view> names) {
  for (const auto name : names)
    if (const auto at = table.find(name); at >= 0) return at;
  return -1;
}

Status append_bids(const fs::path& top, Recordings& out) {
  const auto endings = marker_endings();
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(top, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    const auto name = entry->path().filename().string();
    const bool folder = entry->is_directory(ignored);
    if (folder && (name.starts_with('.') || (entry.depth() == 0 && !name.starts_with("sub-"))))
      entry.disable_recursion_pending();
    if (folder || entry.depth() == 0 || name.starts_with('.')) continue;
    const auto ending = ending_of(entry->path());
    // Of the tables of BIDS those of motion alone are recordings.
    const bool table = ending == ".tsv" && !name.ends_with("_motion.tsv");
    if (!table && std::ranges::find(endings, ending) != endings.end()) found.push_back(entry->path());
  }
  if (error)
    return fail(Code::io, fmt::format("{}: the folder cannot be read ({})", top.string(), error.message()));
  if (found.empty())
    return fail(Code::bad_input,
                fmt::format("{}: its folders sub-... hold no recording of markers", top.string()));
  std::ranges::sort(found);
  out.files.insert(out.files.end(), found.begin(), found.end());
  return {};
}

bool holds_participants(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    const auto name = entry->path().filename().string();
    if (name.starts_with("sub-") && is_entity(name) && entry->is_directory(ignored)) return true;
  }
  return false;
}

}  // namespace

RecordingName name_of_recording(const fs::path& path) {
  RecordingName out{.file = path.filename().string()};
  const auto stem = path.stem().string();
  auto parts = parts_of(stem);
  if (parts.front().starts_with("sub-") && is_entity(parts.front())) {
    if (parts.size() > 1 && !is_entity(parts.back())) parts.pop_back();  // "motion"
    out.participant = parts.front();
    parts.erase(parts.begin());
    if (!parts.empty() && parts.front().starts_with("ses-") && is_entity(parts.front())) {
      out.session = parts.front();
      parts.erase(parts.begin());
    }
    for (const auto& part : parts) out.trial += (out.trial.empty() ? "" : "_") + part;
  }
  if (out.participant.empty()) out.participant = folder_called(path, "sub-");
  if (out.session.empty()) out.session = folder_called(path, "ses-");
  if (out.trial.empty()) out.trial = stem;
  return out;
}

Result<Participants> read_participants(const fs::path& path) {
  auto table = io::read_tidy_csv(path);
  if (!table) return std::unexpected(table.error());
  Participants out{.table = std::move(*table)};
  const auto& read = out.table;
  out.file = find_one_of(read, {"file", "filename"});
  out.participant = find_one_of(read, {"participant_id", "participant"});
  out.session = find_one_of(read, {"session_id", "session"});
  out.trial = find_one_of(read, {"trial", "trial_id"});
  if (out.participant < 0 && out.file < 0)
    return fail(
        Code::bad_input,
        fmt::format(
            "{}: no column is called participant_id (or file), so that nobody knows whose rows these are",
            path.string()));
  std::map<std::string, std::int64_t> seen;
  for (std::int64_t row = 0; row < read.rows(); ++row) {
    const auto cell = [&](std::int64_t column) { return column < 0 ? std::string() : read(row, column); };
    const auto key = out.file >= 0 ? cell(out.file) : cell(out.participant) + " " + cell(out.session);
    const auto line = read.line_of[static_cast<std::size_t>(row)];
    if (const auto [first, is_new] = seen.emplace(key, line); !is_new)
      return fail(Code::bad_input, fmt::format("{}: line {}: {} has a line before, {}", path.string(), line,
                                               printable(key, kShown), first->second));
  }
  for (std::int64_t column = 0; column < std::ssize(read.columns); ++column)
    if (column != out.file && column != out.participant && column != out.session && column != out.trial)
      out.more.push_back(column);
  return out;
}

bool take_participant(const Participants& participants, RecordingName& name) {
  const auto& [table, file, participant, session, trial, more] = participants;
  std::int64_t found = -1;
  const auto stem = fs::path(name.file).stem().string();
  for (std::int64_t row = 0; row < table.rows() && found < 0; ++row) {
    const bool same = file >= 0 ? table(row, file) == name.file || table(row, file) == stem ||
                                      fs::path(table(row, file)).filename() == name.file
                                : is_same(table(row, participant), name.participant, "sub-") &&
                                      (session < 0 || is_same(table(row, session), name.session, "ses-"));
    if (same) found = row;
  }
  if (found >= 0 && file >= 0)
    for (const auto& [column, text] : {std::pair{participant, &name.participant},
                                       std::pair{session, &name.session}, std::pair{trial, &name.trial}})
      if (column >= 0) *text = known(table(found, column));
  name.more.clear();
  for (const auto column : more) {
    const auto& title = table.columns[static_cast<std::size_t>(column)];
    const bool taken = std::ranges::find(kOwnColumns, title) != kOwnColumns.end();
    name.more.emplace_back(taken ? "participant_" + title : title,
                           found < 0 ? std::string() : known(table(found, column)));
  }
  return found >= 0;
}

Result<Recordings> list_recordings(const std::vector<fs::path>& given) {
  Recordings out;
  for (const auto& path : given) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored) && holds_participants(path)) {
      if (auto s = append_bids(path, out); !s) return std::unexpected(s.error());
      continue;
    }
    auto list = list_inputs({path}, marker_endings());
    if (!list) return std::unexpected(list.error());
    std::ranges::move(list->files, std::back_inserter(out.files));
    std::ranges::move(list->notes, std::back_inserter(out.notes));
  }
  std::map<std::string, fs::path> seen;
  for (const auto& path : out.files)
    if (const auto [other, is_new] = seen.emplace(name_of_recording(path).key(), path); !is_new)
      return fail(Code::usage,
                  fmt::format("{} and {}: no name, participant or session tells them apart; give one of them "
                              "another name, or put them into folders sub-... and ses-...",
                              other->second.string(), path.string()));
  return out;
}

std::string name_columns() { return "file,participant,session,trial"; }

std::string name_cells(const RecordingName& name) {
  return table_cell(name.file) + "," + table_cell(name.participant) + "," + table_cell(name.session) + "," +
         table_cell(name.trial);
}

std::string more_columns(const RecordingName& name) {
  std::string out;
  for (const auto& [column, value] : name.more) out += "," + table_cell(column);
  return out;
}

std::string more_cells(const RecordingName& name) {
  std::string out;
  for (const auto& [column, value] : name.more) out += "," + table_cell(value);
  return out;
}

std::string span_columns(const RecordingName& name) {
  std::string out;
  for (const auto& column : name.spans.columns) out += "," + table_cell(column);
  return out;
}

std::string span_cell(const RecordingName& name, const std::string& span, std::size_t column) {
  const auto at = name.spans.cells.find(span);
  return at == name.spans.cells.end() || column >= at->second.size() ? "" : at->second[column];
}

std::string span_cells(const RecordingName& name, const std::string& span) {
  std::string out;
  for (std::size_t k = 0; k < name.spans.columns.size(); ++k)
    out += "," + table_cell(span_cell(name, span, k));
  return out;
}

void unite_span_columns(const std::vector<RecordingName*>& names) {
  std::vector<std::string> all;
  for (const auto* name : names)
    for (const auto& column : name->spans.columns)
      if (std::ranges::find(all, column) == all.end()) all.push_back(column);
  for (auto* name : names) {
    SpanLabels united{.columns = all, .cells = {}};
    for (const auto& [span, cells] : name->spans.cells) {
      auto& row = united.cells[span];
      for (const auto& column : all) {
        const auto own = std::ranges::find(name->spans.columns, column) - name->spans.columns.begin();
        row.push_back(span_cell(*name, span, static_cast<std::size_t>(own)));
      }
    }
    name->spans = std::move(united);
  }
}

void name_apart(SpanLabels& labels, std::string_view table_columns) {
  const std::string all = fmt::format(",{},", table_columns);
  for (auto& column : labels.columns)
    if (all.find(fmt::format(",{},", column)) != std::string::npos) column = "span_" + column;
}

}  // namespace kinemark::pipeline
