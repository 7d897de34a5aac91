// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/input/journal_input.h"

#include <fmt/core.h>

#include <system_error>
#include <utility>

#include "kinemark/core/utf8.h"
#include "kinemark/io/edits/edit_line.h"
#include "kinemark/io/input/file_hash.h"

namespace kinemark::io {

namespace fs = std::filesystem;

namespace {

/// walk.c3d and walk.trc have one place for a journal: it is of the one that it names.
bool is_of_another(const EditsRead& read, const data::EditedRecording& recording) {
  return read.list.recording.name != recording.name && !read.list.recording.same_bytes(recording);
}

Error with_way_out(const Error& error) {
  return {.code = error.code,
          .message = fmt::format("{}; --edits none passes the journal over", error.message)};
}

Result<Journal> match_journal(const fs::path& path, const EditsSource& source) {
  auto read = read_edits(path);
  if (!read) return std::unexpected(read.error());
  const auto identity = identify_recording(source.recording);
  if (!identity) return std::unexpected(identity.error());
  Journal journal{.beside_it = source.edits == kEditsBeside};
  const std::string whose = printable(read->list.recording.name);
  if (journal.beside_it && is_of_another(*read, *identity)) {
    journal.notes.push_back(fmt::format("{} is of '{}' and is not applied", path.string(), whose));
    return journal;
  }
  const auto matches = check_recording(path, read->list.recording, *identity);
  if (!matches && !source.force) return std::unexpected(matches.error());
  auto in_force = read->list.edits_in_force();
  if (!in_force) return fail_at(path.string(), in_force.error());
  auto file = record_input("edits", path);
  if (!file) return std::unexpected(file.error());
  journal.file = std::move(*file);
  journal.digest = digest_of(*in_force);
  journal.in_force = std::move(*in_force);
  journal.notes = std::move(read->notes);
  if (!matches)
    journal.notes.push_back(
        fmt::format("{}: these edits are of '{}' and were applied to another recording, {}", path.string(),
                    whose, source.recording.string()));
  return journal;
}

}  // namespace

fs::path edits_of(const fs::path& recording) {
  return recording.parent_path() / (recording.stem().string() + "_edits.jsonl");
}

Result<data::EditedRecording> identify_recording(const fs::path& recording) {
  auto hash = hash_file(recording);
  if (!hash) return std::unexpected(hash.error());
  return data::EditedRecording{
      .name = to_utf8(recording.filename().string()), .bytes = hash->bytes, .hash = std::move(hash->hex)};
}

Result<EditsRead> read_edits_of(const fs::path& journal, const data::EditedRecording& recording, bool force) {
  std::error_code absent;
  if (!fs::exists(journal, absent)) {
    EditsRead none;
    none.list.recording = recording;
    return none;
  }
  auto read = read_edits(journal);
  if (!read) return std::unexpected(read.error());
  if (force) return read;
  if (auto s = check_recording(journal, read->list.recording, recording); !s)
    return std::unexpected(s.error());
  return read;
}

Result<data::EditList> append_edit(const fs::path& journal, const data::EditedRecording& recording,
                                   std::size_t before, data::Edit edit, bool force) {
  auto open = EditJournal::open(journal, recording, force);
  if (!open) return std::unexpected(open.error());
  if (open->list().edits.size() != before)
    return fail(Code::io,
                fmt::format("{}: another program edited it meanwhile; try again", journal.string()));
  if (auto s = open->append(std::move(edit)); !s) return std::unexpected(s.error());
  return open->list();
}

Error Journal::failure(const Error& error) const {
  const Error named = fail_at(file->path, error).error();
  return beside_it ? with_way_out(named) : named;
}

Result<Journal> read_journal(const EditsSource& source) {
  if (source.edits.empty() || source.edits == kEditsNone) return Journal{};
  const bool beside_it = source.edits == kEditsBeside;
  const fs::path path = beside_it ? edits_of(source.recording) : source.edits;
  std::error_code absent;
  if (beside_it && !fs::exists(path, absent)) return Journal{};
  auto journal = match_journal(path, source);
  if (!journal && beside_it) return std::unexpected(with_way_out(journal.error()));
  return journal;
}

}  // namespace kinemark::io
