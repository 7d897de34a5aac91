// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a recording holds. Byte by byte: docs/formats/recording.md
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "kinemark/core/array.h"

namespace kinemark::io {

/// Bytes that are written before they are read.
using Bytes = Array<std::byte>;

/// Largest group of records that is written or read in one piece; a file that claims more is damaged.
inline constexpr std::size_t kMaxGroupBytes = 16U << 20;

/// A stream of messages of one kind.
struct RecordingChannel {
  std::string topic;                            ///< "/counts"
  std::string message_encoding;                 ///< how a message's bytes are made
  std::string schema_name;                      ///< empty: no schema
  std::string schema_encoding;                  ///< language of schema_text
  std::string schema_text;                      ///< what a message's bytes mean
  std::map<std::string, std::string> metadata;  ///< "rate_hz": its nominal rate, by which clocks are judged
  friend bool operator==(const RecordingChannel&, const RecordingChannel&) = default;  ///< all fields alike
};

/// One message. `data` belongs to whoever made the message.
struct RecordingMessage {
  std::uint16_t channel = 0;   ///< index of the channel, from 0 in the order in which they were added
  std::uint32_t sequence = 0;  ///< counts up by one for each message of a channel; a step of more is a loss
  std::uint64_t log_time_ns = 0;      ///< when it was recorded, ns since 1970
  std::uint64_t publish_time_ns = 0;  ///< when it was sent, ns since 1970
  std::span<const std::byte> data;    ///< as message_encoding says
};

/// Named texts about the whole recording: the rig, the scenario, the subject.
struct RecordingMetadata {
  std::string name;                           ///< of this set of values
  std::map<std::string, std::string> values;  ///< key and value
  friend bool operator==(const RecordingMetadata&, const RecordingMetadata&) = default;  ///< all fields alike
};

}  // namespace kinemark::io
