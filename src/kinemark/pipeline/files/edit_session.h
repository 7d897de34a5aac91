// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A recording that somebody edits one operation after the other: what `run_edit` does for one, without
// reading the recording and applying all edits anew for each.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/pipeline/files/edit_job.h"
#include "kinemark/stages/trajectory/edits/apply_edits.h"
#include "kinemark/stages/trajectory/edits/edit_changes.h"

namespace kinemark::pipeline {

/// Options of an EditSession.
struct EditSessionOptions {
  std::uint64_t seed = 1;                     ///< of fills, as EditOptions
  int threads = 1;                            ///< 0: all cores. Any number gives the same bits.
  std::size_t most_kept_bytes = 256UL << 20;  ///< of states kept so that undo and redo need not apply edits
};

/// The recording as it was read, the journal beside it, and what the edits in force make of the recording.
///
/// The journal is not held open: others may append meanwhile, which refresh() and append() see. Not for
/// several threads at once.
class EditSession {
 public:
  /// Read a recording and its journal, if it has one, and apply it. Fails as io::read_marker_input(),
  /// io::read_edits_of() and trajectory::apply_edits(); Code::bad_input for a recording that tells no frame
  /// rate.
  [[nodiscard]] static Result<EditSession> open(const std::filesystem::path& recording,
                                                const EditSessionOptions& options = {});

  /// Read the journal again. After a failure everything is as it was.
  [[nodiscard]] Status refresh();
  /// Try an operation on what is there, and append it to the journal: it is on the disk when this returns
  /// true. False: the journal holds another number of operations than `expected`, and nothing was written.
  /// Fails as Edit::check(), trajectory::apply_edits() and io::append_edit(); nothing was written then
  /// either.
  [[nodiscard]] Result<bool> append(data::Edit edit, std::size_t expected);

  [[nodiscard]] const io::MarkerInput& recorded() const { return recorded_; }  ///< as it was read
  [[nodiscard]] const data::Trial& now() const { return now_->edited.trial; }  ///< with the edits in force
  [[nodiscard]] EditOutcome outcome() const;                                   ///< what is in the journal
  /// How the recording differs from what it was before the last operation that came here; empty before one.
  [[nodiscard]] const std::vector<trajectory::MarkerChange>& last_changes() const { return last_changes_; }
  /// How it differs from what was recorded.
  [[nodiscard]] const std::vector<trajectory::MarkerChange>& all_changes() const { return now_->changes; }
  [[nodiscard]] std::size_t bytes() const;  ///< of all states that are kept, about

 private:
  /// What operations in force make of the recording.
  struct State {
    std::vector<data::Edit> in_force;
    trajectory::EditedTrial edited;
    std::vector<trajectory::MarkerChange> changes;  ///< from what was recorded
  };
  using StateIs = std::shared_ptr<const State>;

  EditSession() = default;
  [[nodiscard]] Result<StateIs> state_of(std::vector<data::Edit> in_force) const;
  void take(data::EditList list, StateIs state);

  std::filesystem::path journal_;
  EditSessionOptions options_;
  io::MarkerInput recorded_;
  data::EditedRecording identity_;
  data::EditList list_;
  std::vector<std::string> notes_;
  StateIs now_;
  std::deque<StateIs> kept_;  ///< used last first, `now_` among them
  std::vector<trajectory::MarkerChange> last_changes_;
};

}  // namespace kinemark::pipeline
