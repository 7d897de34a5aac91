// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/recording/recording.h"

namespace kinemark::io {

/// Encodes channels, metadata and messages as the bytes of a recording; does not access files. The bytes of
/// all calls, in order, are the recording; every call but finish() makes one group: records, then a check
/// record that covers them and follows from the check before.
class RecordingEncoder {
 public:
  /// Magic and header: the first call, once.
  void begin(Bytes& out);
  /// Declare a channel; its index. Up to 65535 channels with a topic each. Code::usage otherwise.
  [[nodiscard]] Result<std::uint16_t> add_channel(const RecordingChannel& channel, Bytes& out);
  /// Note names and values, at any place among the messages.
  [[nodiscard]] Status add_metadata(const RecordingMetadata& metadata, Bytes& out);
  /// One or more messages that a reader gets all or none of. Code::usage when they do not fit kMaxGroupBytes.
  [[nodiscard]] Status add_messages(std::span<const RecordingMessage> messages, Bytes& out);
  /// Summary, its index and the end: the last call. O(channels + metadata).
  void finish(Bytes& out);

  [[nodiscard]] std::int64_t messages() const { return messages_; }  ///< messages encoded so far

 private:
  struct ChannelCount {
    std::string record;  ///< as written, for the summary
    std::uint64_t messages = 0;
  };
  struct MetadataExtent {
    std::string name;
    std::uint64_t offset = 0, length = 0;
  };
  Status seal(std::size_t begin, Bytes& out);

  std::uint64_t offset_ = 0;  ///< bytes made so far
  std::uint64_t check_ = 0;   ///< value of the last check record
  std::vector<ChannelCount> channels_;
  std::vector<std::string> schemas_;  ///< records, as written
  std::vector<MetadataExtent> metadata_;
  std::int64_t messages_ = 0;
  std::uint64_t first_time_ns_ = 0, last_time_ns_ = 0;
};

}  // namespace kinemark::io
