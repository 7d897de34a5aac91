// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/edit_input.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <system_error>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/edits/edit_line.h"
#include "kinemark/pipeline/files/file_hash.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/workflow/prepare/prepare.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

namespace {

/// walk.c3d and walk.trc have one place for a journal: it is of the one that it names.
bool is_of_another(const io::EditsRead& read, const data::EditedRecording& recording) {
  return read.list.recording.name != recording.name && !read.list.recording.same_bytes(recording);
}

}  // namespace

fs::path edits_of(const fs::path& recording) { return beside(recording, "_edits.jsonl"); }

Result<data::EditedRecording> identify_recording(const fs::path& recording) {
  auto hash = hash_file(recording);
  if (!hash) return std::unexpected(hash.error());
  return data::EditedRecording{
      .name = to_utf8(recording.filename().string()), .bytes = hash->bytes, .hash = std::move(hash->hex)};
}

Result<io::EditsRead> read_edits_of(const fs::path& journal, const data::EditedRecording& recording,
                                    bool force) {
  std::error_code absent;
  if (!fs::exists(journal, absent)) {
    io::EditsRead none;
    none.list.recording = recording;
    return none;
  }
  auto read = io::read_edits(journal);
  if (!read) return std::unexpected(read.error());
  if (force) return read;
  if (auto s = io::check_recording(journal, read->list.recording, recording); !s)
    return std::unexpected(s.error());
  return read;
}

Result<data::EditList> append_edit(const fs::path& journal, const data::EditedRecording& recording,
                                   std::size_t before, data::Edit edit, bool force) {
  auto open = io::EditJournal::open(journal, recording, force);
  if (!open) return std::unexpected(open.error());
  if (open->list().edits.size() != before)
    return fail(Code::io,
                fmt::format("{}: another program edited it meanwhile; try again", journal.string()));
  if (auto s = open->append(std::move(edit)); !s) return std::unexpected(s.error());
  return open->list();
}

Result<UsedJournal> take_edits(const EditsSource& source, data::Recording& recording) {
  UsedJournal used;
  if (source.edits.empty() || source.edits == kEditsNone) return used;
  auto path = source.edits;
  const bool beside_it = path == kEditsBeside;
  if (beside_it) {
    path = edits_of(source.recording);
    std::error_code absent;
    if (!fs::exists(path, absent)) return used;
  }
  auto read = io::read_edits(path);
  if (!read) return std::unexpected(read.error());
  const auto identity = identify_recording(source.recording);
  if (!identity) return std::unexpected(identity.error());
  auto& notes = recording.notes;
  const std::string whose = printable(read->list.recording.name);
  if (beside_it && is_of_another(*read, *identity)) {
    notes.push_back(fmt::format("{} is of '{}' and is not applied", path.string(), whose));
    return used;
  }
  const auto matches = io::check_recording(path, read->list.recording, *identity);
  if (!matches && !source.force) return std::unexpected(matches.error());
  const auto in_force = read->list.edits_in_force();
  if (!in_force) return fail_at(path.string(), in_force.error());
  auto file = record_input("edits", path);
  if (!file) return std::unexpected(file.error());
  data::Recording edited{.trial = recording.trial};
  if (auto s = workflow::apply_edits(edited, *in_force, source.seed, source.threads); !s)
    return fail_at(path.string(), s.error());
  recording.trial = std::move(edited.trial);
  recording.edits = std::move(edited.edits);
  std::ranges::move(read->notes, std::back_inserter(notes));
  if (!matches)
    notes.push_back(fmt::format("{}: these edits are of '{}' and were applied to another recording, {}",
                                path.string(), whose, source.recording.string()));
  for (const auto& note : edited.notes) notes.push_back(fmt::format("{}: {}", path.string(), note));
  notes.push_back(fmt::format("{} of {} {} applied", counted(std::ssize(*in_force), "edit"), path.string(),
                              in_force->size() == 1 ? "was" : "were"));
  used.file = std::move(*file);
  used.digest = io::digest_of(*in_force);
  return used;
}

std::vector<std::pair<std::string, std::string>> edit_options(const data::EditsInForce& edits,
                                                              const UsedJournal& journal) {
  std::vector<std::pair<std::string, std::string>> options;
  if (!journal.file) return options;
  options.emplace_back("edits in force", fmt::format("{}, XXH3-64 {}", edits.in_force, journal.digest));
  for (const auto& region : edits.regions)
    options.emplace_back(fmt::format("region '{}'", region.name),
                         fmt::format("frames {} to {}", region.first_frame, region.last_frame));
  return options;
}

}  // namespace kinemark::pipeline
