// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a person changed in a recording: a list of operations, kept beside the data and never inside it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::data {

/// What an edit does. In brackets: the members of Edit that it needs, then those that it may have.
enum class EditKind : std::uint8_t {
  relabel,       ///< samples of a marker become those of another [marker, other; range]
  swap,          ///< two markers exchange their samples [marker, other; range, or frames]
  cut,           ///< samples of a marker become `rejected` [marker; range]
  fill,          ///< gaps of a marker are filled [marker; method, range]
  unfill,        ///< filled samples of a marker become missing [marker; range]
  crop,          ///< other frames are left out [one end of the range, or both]
  mark_event,    ///< a new event [label, time_s; context]
  move_event,    ///< an event gets another time [label, time_s, to_s; context]
  delete_event,  ///< an event is left out [label, time_s; context]
  region,        ///< a stretch of frames gets a name [name, both ends of the range]
  undo,          ///< the last `count` operations in force are no longer [count]
  redo,          ///< the last `count` that were undone are in force again [count]
};

/// "relabel", "swap", "cut", "fill", "unfill", "crop", "mark", "move", "delete", "region", "undo", "redo".
[[nodiscard]] std::string_view to_string(EditKind kind);
/// The kind of that name. The failure (Code::bad_input) lists all names.
[[nodiscard]] Result<EditKind> parse_edit_kind(std::string_view name);

/// One operation. Which members count is said by its kind; the others are as they are here.
struct Edit {
  EditKind kind = EditKind::cut;  ///< what is done
  std::string marker;             ///< whose samples; a subject's prefix may be left out
  std::string other;              ///< relabel: what the marker becomes; swap: its partner
  /// First and last frame in the file's own numbers, both included; none: from the start, to the end.
  std::optional<std::int64_t> first_frame, last_frame;
  std::string frames;   ///< of a swap, instead of a range: its frames, as parse_frame_list() reads them
  std::string method;   ///< of a fill, as `clean --gaps` has them; empty: "auto"
  std::string label;    ///< of an event
  std::string context;  ///< of an event, may be empty
  double time_s = 0.0;  ///< of an event, on the recording's clock: where it is or shall be
  double to_s = 0.0;    ///< where an event is moved to
  std::string name;     ///< of a region
  int count = 1;        ///< operations to undo or redo

  std::string id;      ///< of this operation, unique in its list
  std::string made;    ///< when, "2026-11-24T09:30:00Z"; tells nothing of the result; may be empty
  std::string author;  ///< by whom; may be empty
  int line = 0;        ///< of the journal, for messages; 0: of none

  /// All that can be said without a recording: Code::bad_input, one sentence.
  [[nodiscard]] Status check() const;
  /// Whether both do the same: everything but id, made, author and line.
  [[nodiscard]] bool same_as(const Edit& that) const;
};

/// The operation in words, "swap of 'LASI' and 'RASI', frames 120 to 300".
[[nodiscard]] std::string describe(const Edit& edit);

/// The recording that edits are of.
struct EditedRecording {
  std::string name;        ///< of the file, without its folder
  std::int64_t bytes = 0;  ///< size of the file
  std::string hash;        ///< of its bytes, XXH3-64, 16 lower-case digits

  /// Whether both are the same bytes, under whatever name.
  [[nodiscard]] bool same_bytes(const EditedRecording& that) const {
    return bytes == that.bytes && hash == that.hash;
  }
};

/// Operations in the order in which they were made, undo and redo among them.
struct EditList {
  EditedRecording recording;  ///< that they are of
  std::vector<Edit> edits;    ///< only ever appended to

  /// Indices of the operations in force, in their order, without undo and redo. A new operation after an undo
  /// takes away what could be redone. Code::bad_input where there is less to undo or redo than asked, with
  /// the line of the edit.
  [[nodiscard]] Result<std::vector<std::size_t>> in_force() const;
  /// Those operations themselves.
  [[nodiscard]] Result<std::vector<Edit>> edits_in_force() const;
  /// How many operations can be taken back and how many brought back; 0 and 0 of a list that is wrong.
  struct Depth {
    std::size_t undo = 0;  ///< operations in force
    std::size_t redo = 0;  ///< operations undone
  };
  [[nodiscard]] Depth depth() const;  ///< of undo and redo
};

/// A stretch of frames with a name, in the file's own numbers, both ends included.
struct Region {
  std::string name;                                                ///< unique
  std::int64_t first_frame = 0;                                    ///< number of its first frame
  std::int64_t last_frame = 0;                                     ///< number of its last frame
  friend bool operator==(const Region&, const Region&) = default;  ///< the same name and frames
};

/// Where an edit stands, for the beginning of a message: "line 7", else "edit 'id'", else "new edit".
[[nodiscard]] std::string place_of(const Edit& edit);

}  // namespace kinemark::data
