// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "kinemark/core/result.h"
#include "kinemark/io/recording/recording.h"

namespace kinemark::io {

/// When bytes are forced from memory to the disk. In every case what append() has acknowledged survives the
/// death of the program (kill -9 included); the policy decides what survives a power cut.
enum class SyncPolicy : std::uint8_t {
  never,       ///< the system's own time, about 30 s on Linux; append() costs one write()
  background,  ///< a thread of its own asks every sync_interval_s; append() never waits for the disk
  always,      ///< before append() returns; costs milliseconds to tens of milliseconds each
};

/// Options of RecordingWriter.
struct RecordingOptions {
  bool force = false;                        ///< replace a file that exists
  SyncPolicy sync = SyncPolicy::background;  ///< when bytes are forced to the disk
  double sync_interval_s = 1.0;              ///< of the background thread; 0.01 to 3600

  /// Ranges hold.
  [[nodiscard]] Status check() const;
};

/// Writes a recording as it happens: append-only, at every moment a valid beginning of an MCAP file.
///
/// append() returns once the whole group is with the operating system: acknowledged. A program killed at any
/// moment leaves every acknowledged message readable; at most the one being written is torn, and readers see
/// that. A failure (disk full, file too large) takes the torn bytes back, is reported once by append(), and
/// ends the recording: what was acknowledged before stays. Not for two threads at once.
class RecordingWriter {
 public:
  /// The file appears at once, with its header; Code::io when it exists already (unless options.force) or
  /// cannot be made, Code::usage for options out of range.
  static Result<RecordingWriter> create(const std::filesystem::path& path,
                                        const RecordingOptions& options = {});
  RecordingWriter(RecordingWriter&&) noexcept;  ///< takes the open recording over
  RecordingWriter& operator=(RecordingWriter&&) = delete;
  /// Without close() the file stays as after a kill: readable, marked as not closed.
  ~RecordingWriter();

  /// Index of the new channel, from 0.
  [[nodiscard]] Result<std::uint16_t> add_channel(const RecordingChannel& channel);
  /// Note names and values, at any place among the messages.
  [[nodiscard]] Status add_metadata(const RecordingMetadata& metadata);
  /// All messages or none, in one write().
  [[nodiscard]] Status append(std::span<const RecordingMessage> messages);
  /// one message
  [[nodiscard]] Status append(const RecordingMessage& message) { return append({&message, 1}); }
  /// Wait until everything acknowledged is on the disk.
  [[nodiscard]] Status sync();
  /// Summary and end, then sync(). Nothing can be added afterwards.
  [[nodiscard]] Status close();

  /// Messages that survive the death of this program.
  [[nodiscard]] std::int64_t acknowledged() const;
  /// Messages that survive a power cut.
  [[nodiscard]] std::int64_t on_disk() const;

 private:
  struct State;
  explicit RecordingWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace kinemark::io
