// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Detector counts as a recording: one message a frame on the channel /counts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/io/recording/reader.h"
#include "kinemark/io/recording/writer.h"

namespace kinemark::io {

/// Counts with what is known about them (rig, scenario, truth file: named texts).
struct CountsRecording {
  data::Counts counts;                      ///< F x L x C x 4 with times and flags
  std::vector<RecordingMetadata> metadata;  ///< in the order of the file
  RecordingEnd end = RecordingEnd::closed;  ///< how the file ends
  /// Irregularities, one sentence each: not closed, cut, damaged, frames lost, clock jumps.
  std::vector<std::string> warnings;
};

/// The whole of `counts` as a closed recording, which appears whole or not at all. Code::usage when the
/// counts do not validate() or have no LED or camera, Code::io when the file exists (unless `force`) or
/// cannot be written.
[[nodiscard]] Status write_counts(const std::filesystem::path& path, const data::Counts& counts,
                                  std::span<const RecordingMetadata> metadata, bool force);

/// Everything that can be kept of a recording of counts, closed or not, damaged or not. Frames that are
/// missing in between are flagged kCountLost; every irregularity is a warning. Code::bad_input when the file
/// is no recording of counts. Memory: the counts, and at most 16 times the file for frames that are lost.
[[nodiscard]] Result<CountsRecording> read_counts(const std::filesystem::path& path);
/// The same of a recording that is open already and of which nothing was read.
[[nodiscard]] Result<CountsRecording> read_counts(RecordingReader reader);

/// True for a channel that read_counts() reads.
[[nodiscard]] bool carries_counts(const RecordingChannel& channel);

/// One frame of counts; shapes as in data::Counts for a single frame.
struct CountsFrame {
  std::int64_t frame = 0;                ///< counts up; a step of more than 1 says that frames were lost
  double time_s = 0.0;                   ///< when it began, by the clock that counts.time is in
  std::span<const std::int16_t> counts;  ///< L x C x 4
  std::span<const std::uint8_t> flags;   ///< L x C
  std::span<const std::int16_t> dark;    ///< C x 4; empty without a dark slot
};

/// Records counts as they come; see RecordingWriter for what an acknowledged frame survives.
class CountsWriter {
 public:
  /// `like` gives names, rate, conversion times, codes and the dark slot; its frames are not looked at.
  static Result<CountsWriter> create(const std::filesystem::path& path, const data::Counts& like,
                                     std::span<const RecordingMetadata> metadata = {},
                                     const RecordingOptions& options = {});
  /// Note names and values, at any place among the frames; see RecordingWriter::add_metadata().
  [[nodiscard]] Status add_metadata(const RecordingMetadata& metadata) {
    return writer_.add_metadata(metadata);
  }
  /// Returns once the frame is acknowledged. Shapes are a contract; frame in [0, 2^32).
  [[nodiscard]] Status push(const CountsFrame& frame);
  /// Bring what was pushed to the disk; Code::io when that fails.
  [[nodiscard]] Status sync() { return writer_.sync(); }
  /// End the recording with its summary; nothing may be pushed after it.
  [[nodiscard]] Status close() { return writer_.close(); }
  /// frames that a stop of this program cannot lose
  [[nodiscard]] std::int64_t acknowledged() const { return writer_.acknowledged(); }
  /// frames that a loss of power cannot lose
  [[nodiscard]] std::int64_t on_disk() const { return writer_.on_disk(); }

 private:
  CountsWriter(RecordingWriter writer, const data::Counts& like);
  RecordingWriter writer_;
  std::size_t counts_size_ = 0, flags_size_ = 0, dark_size_ = 0;
  double epoch_s_ = 0.0;
  Bytes frame_;
};

}  // namespace kinemark::io
