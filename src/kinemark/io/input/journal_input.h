// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Edits of a recording as an input: the journal beside it, read and matched. Nothing is applied here.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/run_record.h"
#include "kinemark/io/edits/edit_journal.h"

namespace kinemark::io {

/// The value of `--edits` that stands for the journal beside each recording, if it has one.
inline constexpr const char* kEditsBeside = "beside";
/// And the one for no journal.
inline constexpr const char* kEditsNone = "none";

/// The journal of a recording: NAME_edits.jsonl beside it.
[[nodiscard]] std::filesystem::path edits_of(const std::filesystem::path& recording);

/// The recording's name, size and checksum, as journals hold them. Fails as hash_file().
[[nodiscard]] Result<data::EditedRecording> identify_recording(const std::filesystem::path& recording);

/// The journal as it is now; without one, no edit of `recording`. Fails as read_edits(), and unless
/// `force` as check_recording().
[[nodiscard]] Result<EditsRead> read_edits_of(const std::filesystem::path& journal,
                                              const data::EditedRecording& recording, bool force = false);

/// Append an edit that was tried on `before` operations, and return all. It is on the disk then. Code::io
/// when the journal holds another number by now; fails as EditJournal.
[[nodiscard]] Result<data::EditList> append_edit(const std::filesystem::path& journal,
                                                 const data::EditedRecording& recording, std::size_t before,
                                                 data::Edit edit, bool force = false);

/// Edits to apply to a recording as it was read.
struct EditsSource {
  std::filesystem::path edits;  ///< journal; "beside": edits_of(recording), if it is there and does not name
                                ///< another file; "none" or empty: none
  std::filesystem::path recording;  ///< that the trial was read from
  bool force = false;               ///< take those of another recording too
};

/// A journal that is to be applied to a recording.
struct Journal {
  std::optional<data::InputFile> file;  ///< role "edits", with size and checksum; none: there is no journal
  std::string digest;                   ///< of what its edits do, digest_of()
  std::vector<data::Edit> in_force;     ///< in their order
  std::vector<std::string> notes;       ///< what is odd about it, one sentence each
  bool beside_it = false;               ///< nobody named it: it can be passed over

  /// The failure of an edit, as read_journal() fails: with the journal's name, and how to do without it where
  /// nobody named it.
  [[nodiscard]] Error failure(const Error& error) const;
};

/// Read a journal and match it with its recording. Code::bad_input, naming journal and line, as read_edits()
/// and check_recording().
[[nodiscard]] Result<Journal> read_journal(const EditsSource& source);

}  // namespace kinemark::io
