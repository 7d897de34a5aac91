// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/io/recording/reader.h"

namespace kinemark::io {

/// One frame of a recording of counts; shapes as in data::Counts for a single frame.
struct ReadCounts {
  std::uint32_t number = 0;          ///< as recorded; a step of more than one says that frames are missing
  std::vector<std::int16_t> counts;  ///< L x C x 4
  std::vector<std::int16_t> dark;    ///< C x 4; empty without a dark slot
  std::vector<std::uint8_t> flags;   ///< L x C
};

/// Reads a recording of counts frame by frame, in constant memory. read_counts() has all of them at once.
class CountsReader {
 public:
  /// Code::bad_input when it holds no counts before its first frame; else as RecordingReader::open().
  [[nodiscard]] static Result<CountsReader> open(const std::filesystem::path& path);
  /// Names, rate and times of conversions; without a frame.
  [[nodiscard]] const data::Counts& layout() const { return layout_; }
  /// The next frame, or false at the end. Messages of other sizes, and of numbers that go back, are left out.
  /// Code::io when the disk fails.
  [[nodiscard]] Result<bool> next(ReadCounts& frame);

 private:
  explicit CountsReader(RecordingReader reader) : reader_(std::move(reader)) {}
  [[nodiscard]] bool take(const RecordingMessage& message, ReadCounts& frame);

  RecordingReader reader_;
  data::Counts layout_;
  std::uint16_t channel_ = 0;
  std::optional<RecordingMessage> first_;  ///< read by open()
  std::optional<std::uint32_t> last_number_;
};

}  // namespace kinemark::io
