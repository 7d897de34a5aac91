// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/edit_input.h"

#include <fmt/core.h>

#include <system_error>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/edits/edit_line.h"
#include "kinemark/pipeline/files/file_hash.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/stages/trajectory/edits/apply_edits.h"

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

Result<EditsTaken> take_edits(const EditsSource& source, data::Trial& trial) {
  EditsTaken taken;
  if (source.edits.empty() || source.edits == kEditsNone) return taken;
  auto path = source.edits;
  const bool beside_it = path == kEditsBeside;
  if (beside_it) {
    path = edits_of(source.recording);
    std::error_code absent;
    if (!fs::exists(path, absent)) return taken;
  }
  auto read = io::read_edits(path);
  if (!read) return std::unexpected(read.error());
  const auto recording = identify_recording(source.recording);
  if (!recording) return std::unexpected(recording.error());
  if (beside_it && is_of_another(*read, *recording)) {
    taken.notes.push_back(
        fmt::format("{} is of '{}' and is not applied", path.string(), printable(read->list.recording.name)));
    return taken;
  }
  taken.notes = std::move(read->notes);
  if (auto s = io::check_recording(path, read->list.recording, *recording); !s) {
    if (!source.force) return std::unexpected(s.error());
    taken.notes.push_back(fmt::format("{}: these edits are of '{}' and were applied to another recording, {}",
                                      path.string(), printable(read->list.recording.name),
                                      source.recording.string()));
  }
  const auto in_force = read->list.edits_in_force();
  if (!in_force) return fail_at(path.string(), in_force.error());
  auto edited = trajectory::apply_edits(trajectory::EditedTrial{.trial = trial}, *in_force,
                                        {.seed = source.seed, .threads = source.threads});
  if (!edited) return fail_at(path.string(), edited.error());
  auto file = record_input("edits", path);
  if (!file) return std::unexpected(file.error());
  trial = std::move(edited->trial);
  taken.file = std::move(*file);
  taken.in_force = in_force->size();
  taken.digest = io::digest_of(*in_force);
  taken.regions = std::move(edited->regions);
  for (const auto& edit : *in_force)
    if (edit.kind == data::EditKind::swap) taken.swapped.emplace_back(edit.marker, edit.other);
  for (const auto& note : edited->notes) taken.notes.push_back(fmt::format("{}: {}", path.string(), note));
  taken.notes.push_back(fmt::format("{} of {} {} applied",
                                    counted(static_cast<std::int64_t>(taken.in_force), "edit"), path.string(),
                                    taken.in_force == 1 ? "was" : "were"));
  return taken;
}

std::vector<std::pair<std::string, std::string>> edit_options(const EditsTaken& taken) {
  std::vector<std::pair<std::string, std::string>> options;
  if (!taken.file) return options;
  options.emplace_back("edits in force", fmt::format("{}, XXH3-64 {}", taken.in_force, taken.digest));
  for (const auto& region : taken.regions)
    options.emplace_back(fmt::format("region '{}'", region.name),
                         fmt::format("frames {} to {}", region.first_frame, region.last_frame));
  return options;
}

}  // namespace kinemark::pipeline
