// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Edits of a recording as an input of jobs: the journal beside the recording, read, matched and applied.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/recording.h"
#include "kinemark/data/run_record.h"
#include "kinemark/io/edits/edit_journal.h"

namespace kinemark::pipeline {

/// The value of `--edits` that stands for the journal beside each recording, if it has one.
inline constexpr const char* kEditsBeside = "beside";
/// And the one for no journal.
inline constexpr const char* kEditsNone = "none";

/// The journal of a recording: NAME_edits.jsonl beside it.
[[nodiscard]] std::filesystem::path edits_of(const std::filesystem::path& recording);

/// The recording's name, size and checksum, as journals hold them. Fails as hash_file().
[[nodiscard]] Result<data::EditedRecording> identify_recording(const std::filesystem::path& recording);

/// The journal as it is now; without one, no edit of `recording`. Fails as io::read_edits(), and unless
/// `force` as io::check_recording().
[[nodiscard]] Result<io::EditsRead> read_edits_of(const std::filesystem::path& journal,
                                                  const data::EditedRecording& recording, bool force = false);

/// Append an edit that was tried on `before` operations, and return all. It is on the disk then. Code::io
/// when the journal holds another number by now; fails as io::EditJournal.
[[nodiscard]] Result<data::EditList> append_edit(const std::filesystem::path& journal,
                                                 const data::EditedRecording& recording, std::size_t before,
                                                 data::Edit edit, bool force = false);

/// Edits to apply to a recording as it was read.
struct EditsSource {
  std::filesystem::path edits;  ///< journal; "beside": edits_of(recording), if it is there and does not name
                                ///< another file; "none" or empty: none
  std::filesystem::path recording;  ///< that the trial was read from
  bool force = false;               ///< apply those of another recording too
  std::uint64_t seed = 1;           ///< of fills
  int threads = 1;                  ///< 0: all cores. Any number gives the same bits.
};

/// The journal whose edits were applied.
struct UsedJournal {
  std::optional<data::InputFile> file;  ///< role "edits", with size and checksum; none: there was no journal
  std::string digest;                   ///< of what its edits do, io::digest_of()
};

/// Apply a journal to a recording, whose edits and notes say what was done. Code::bad_input, naming journal
/// and line, as io::read_edits(), io::check_recording() and workflow::apply_edits(); the trial is then as it
/// was.
[[nodiscard]] Result<UsedJournal> take_edits(const EditsSource& source, data::Recording& recording);

/// The same as options of a run's record: how many are in force and what they come to, and the regions; none
/// where there was no journal.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> edit_options(const data::EditsInForce& edits,
                                                                            const UsedJournal& journal);

}  // namespace kinemark::pipeline
