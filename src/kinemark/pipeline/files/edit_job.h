// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One edit of a recording into its journal, or what is in it.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

/// What `kinemark edit` is asked to do. `force` takes a journal of another recording too.
struct EditJob : JobSettings {
  std::filesystem::path input;     ///< recording, which is only read
  std::filesystem::path edits;     ///< its journal; empty: io::edits_of(input)
  double rate_hz = 0.0;            ///< of a recording that tells none; 0: not given
  std::string unit;                ///< of coordinates, of a table that states none; empty: not given
  std::optional<data::Edit> edit;  ///< to append; none: only look
  /// To append: an exchange back of each two markers that surely carry each other's label, with the author
  /// and the time of `edit`, whose kind does not matter then.
  bool exchanges = false;
  /// The ends of its range, or of an event `at` and `to`: "120", a frame by the file's own number, or "1.5s",
  /// a time on the recording's clock; empty: not given. Of a range the frames within.
  std::string from, to, at;
};

/// What is in the journal now.
struct EditOutcome : JobOutcome {
  data::EditList list;                ///< all operations
  std::vector<data::Edit> in_force;   ///< those that count
  std::vector<data::Region> regions;  ///< that they name
  std::string digest;                 ///< of what is in force, io::digest_of()
  std::filesystem::path journal;      ///< which file it is; not there before the first edit
  std::size_t appended = 0;           ///< operations that this run added, the last of the list
};

/// Append an edit, after it was tried with those before it: what cannot be applied is refused and the journal
/// stays as it was. When this returns the edit is on the disk. Without `edit` nothing is written. Fails as
/// io::read_marker_input(), take_edits() and io::EditJournal; Code::usage for ends that are no frame and no
/// time.
[[nodiscard]] Result<EditOutcome> run_edit(const EditJob& job);

/// The time, for Edit::made: "2026-11-24T09:30:00Z".
[[nodiscard]] std::string time_of_edit();

/// The outcome for programs: {"journal", "digest", "edits": [{..., "in_force", "words"}], "regions", "undo",
/// "redo"}.
[[nodiscard]] nlohmann::ordered_json edit_json(const EditOutcome& outcome);

}  // namespace kinemark::pipeline
