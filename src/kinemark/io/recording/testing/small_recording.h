// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A recording of a few hundred bytes in memory, and all that a reader finds in any bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/io/recording/encoder.h"
#include "kinemark/io/recording/reader.h"

namespace kinemark::io::internal {

struct SmallRecording {
  Bytes bytes;
  std::vector<std::size_t> group_ends;      ///< of the groups with messages
  std::vector<std::size_t> messages_until;  ///< messages of the recording up to there
  std::size_t data_end = 0;                 ///< where the summary begins
};

/// The data of message number i of the recording below.
inline std::string text_of(std::uint32_t i) {
  return "message " + std::to_string(i) + std::string(i % 5, '.');
}

/// `messages` messages on /a at 10 Hz; every fourth group holds one on /b as well, with the same text.
inline SmallRecording make_small_recording(std::uint32_t messages, bool finish = true) {
  SmallRecording out;
  RecordingEncoder encoder;
  encoder.begin(out.bytes);
  const bool declared =
      encoder.add_metadata({"subject", {{"name", "Ada"}, {"side", "left"}}}, out.bytes).has_value() &&
      encoder.add_channel({"/a", "text", "Text", "x-text", "any text", {{"rate_hz", "10"}}}, out.bytes)
          .has_value() &&
      encoder.add_channel({"/b", "text", "Text", "x-text", "any text", {}}, out.bytes).has_value();
  if (!declared) return {};
  for (std::uint32_t i = 0; i < messages; ++i) {
    const std::string text = text_of(i);
    const auto data = std::as_bytes(std::span(text));
    const std::uint64_t time_ns = 1'000'000'000ULL + 100'000'000ULL * i;
    std::vector<RecordingMessage> group{{0, i, time_ns, time_ns + 5, data}};
    if (i % 4 == 3) group.push_back({1, i / 4, time_ns, time_ns, data});
    if (!encoder.add_messages(group, out.bytes)) return {};
    out.group_ends.push_back(out.bytes.size());
    out.messages_until.push_back(static_cast<std::size_t>(encoder.messages()));
  }
  out.data_end = out.bytes.size();
  if (finish) encoder.finish(out.bytes);
  return out;
}

struct Found {
  std::string error;  ///< of open(); empty when it opened
  std::vector<RecordingMessage> messages;
  std::vector<std::string> texts;  ///< of the messages
  std::vector<RecordingChannel> channels;
  std::vector<RecordingMetadata> metadata;
  RecordingEnd end = RecordingEnd::open;
  std::vector<RecordingDamage> damage;
  std::uint64_t kept_until = 0;
};

inline Found read_everything(std::span<const std::byte> bytes, bool skip_damage = false) {
  Found found;
  auto reader = RecordingReader::open(std::make_unique<MemorySource>(bytes, "small.mcap"),
                                      {.skip_damage = skip_damage});
  if (!reader) {
    found.error = reader.error().message;
    return found;
  }
  RecordingMessage message;
  while (*reader->next(message)) {
    found.messages.push_back(message);
    found.texts.emplace_back(reinterpret_cast<const char*>(message.data.data()), message.data.size());
    found.messages.back().data = {};
  }
  found.channels = reader->channels();
  found.metadata = reader->metadata();
  found.end = reader->end();
  found.damage = reader->damage();
  found.kept_until = reader->kept_until();
  return found;
}

}  // namespace kinemark::io::internal
