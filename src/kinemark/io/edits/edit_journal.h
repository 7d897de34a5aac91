// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The journal of a recording's edits: a line for each operation, undo and redo too, only ever appended to.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"

namespace kinemark::io {

/// A journal as it was read.
struct EditsRead {
  data::EditList list;             ///< the whole lines
  std::size_t whole_bytes = 0;     ///< of the file up to the end of the last whole line
  int lines = 0;                   ///< whole lines, the first and empty ones too
  std::vector<std::string> notes;  ///< a last line without its end, which was left out
};

/// The content of a journal. A last line without newline was being written when the writer ended: nobody was
/// told that it counts, it is left out, and the notes say so. Any other line that is not as written is
/// Code::bad_input, "file: line 7: what is wrong": without it the later ones would mean something else.
/// @param name  of the file, for messages
[[nodiscard]] Result<EditsRead> parse_edits(std::string_view text, const std::string& name);

/// The same of a file, 64 MB at most.
[[nodiscard]] Result<EditsRead> read_edits(const std::filesystem::path& path);

/// Code::bad_input, naming both, when a journal is of another recording than `given`: other bytes, whatever
/// the name.
[[nodiscard]] Status check_recording(const std::filesystem::path& journal,
                                     const data::EditedRecording& recording,
                                     const data::EditedRecording& given);

/// A journal open for appending, by one writer at a time (a lock of the system, gone with its process).
///
/// append() returns when the line is on the disk: what it acknowledged survives a kill and a power cut. After
/// a failure the file is as it was; where not even that can be had, further calls fail.
class EditJournal {
 public:
  /// Open a journal; one that is not there is made by the first append(). An unfinished last line goes.
  /// Code::bad_input for a journal of another recording, unless `force`, and as read_edits(); Code::io where
  /// it cannot be read or written, or another program has it open.
  [[nodiscard]] static Result<EditJournal> open(const std::filesystem::path& path,
                                                const data::EditedRecording& recording, bool force = false);
  EditJournal(EditJournal&& other) noexcept;             ///< takes the open journal over
  EditJournal& operator=(EditJournal&& other) noexcept;  ///< closes its own and takes the other over
  ~EditJournal();

  /// Append an operation. One without an id gets the number of operations before it, plus one.
  /// Code::bad_input where it does not check(), its id is taken, or there is less to undo or redo; Code::io.
  [[nodiscard]] Status append(data::Edit edit);
  /// Append undo of the last operations in force.
  [[nodiscard]] Status undo(int count = 1, std::string made = {});
  /// Append redo of the last that were undone.
  [[nodiscard]] Status redo(int count = 1, std::string made = {});

  [[nodiscard]] const data::EditList& list() const { return list_; }              ///< all that was appended
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }       ///< as given
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }  ///< as EditsRead

 private:
  explicit EditJournal(std::filesystem::path path) : path_(std::move(path)) {}
  Status lock();
  Status begin(std::string_view line);
  Status read(const data::EditedRecording& recording, bool force);
  Status write_line(std::string_view line);
  Status failed(std::string_view what, int error) const;

  std::filesystem::path path_;
  int fd_ = -1;          ///< -1: there is no file yet
  bool broken_ = false;  ///< what is in the file is not known
  std::size_t bytes_ = 0;
  int lines_ = 0;
  data::EditList list_;
  std::vector<std::string> notes_;
};

}  // namespace kinemark::io
