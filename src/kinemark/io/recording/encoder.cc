// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/encoder.h"

#include <fmt/core.h>

#include <algorithm>

#include "kinemark/core/check.h"
#include "kinemark/io/recording/internal/mcap.h"

namespace kinemark::io {
namespace {

using namespace internal;

std::string as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint16_t id_of(std::size_t index) { return static_cast<std::uint16_t>(index + 1); }

}  // namespace

/// Close the group that begins at out[begin]: check its size, chain the checksum.
Status RecordingEncoder::seal(std::size_t begin, Bytes& out) {
  const auto group = std::span<const std::byte>(out).subspan(begin);
  if (group.size() > kMaxGroupBytes) {
    const std::size_t bytes = group.size();
    out.resize(begin);
    return fail(Code::usage,
                fmt::format("{} bytes in one piece of a recording; at most {} fit", bytes, kMaxGroupBytes));
  }
  check_ = check_value(group, check_);
  put_u8(out, kCheck);
  put_u64(out, 8);
  put_u64(out, check_);
  offset_ += out.size() - begin;
  return {};
}

void RecordingEncoder::begin(Bytes& out) {
  check(offset_ == 0, "begin() comes first, and once");
  const std::size_t begin = out.size();
  put_raw(out, kMagic);
  {
    const RecordScope record(out, kHeader);
    put_string(out, kProfile);
    put_string(out, "kinemark");
  }
  check(seal(begin, out).has_value(), "a header is small");
}

Result<std::uint16_t> RecordingEncoder::add_channel(const RecordingChannel& channel, Bytes& out) {
  check(offset_ > 0, "begin() comes first");
  if (channels_.size() >= 65535) return fail(Code::usage, "a recording has room for 65535 channels");
  if (channel.topic.empty()) return fail(Code::usage, "a channel of a recording has no topic");
  const std::size_t begin = out.size();
  std::string new_schema;
  std::uint16_t schema_id = 0;
  if (!channel.schema_name.empty()) {
    // The same schema is written once. Its record differs from an older one by the id alone, so compare the
    // rest.
    const auto schema_record = [&](std::uint16_t id) {
      Bytes bytes;
      {
        const RecordScope record(bytes, kSchema);
        put_u16(bytes, id);
        put_string(bytes, channel.schema_name);
        put_string(bytes, channel.schema_encoding);
        put_string(bytes, channel.schema_text);
      }
      return as_text(bytes);
    };
    for (std::size_t i = 0; i < schemas_.size() && schema_id == 0; ++i)
      if (schemas_[i] == schema_record(id_of(i))) schema_id = id_of(i);
    if (schema_id == 0) {
      schema_id = id_of(schemas_.size());
      new_schema = schema_record(schema_id);
      put_raw(out, new_schema);
    }
  }
  const std::size_t channel_begin = out.size();
  {
    const RecordScope record(out, kChannel);
    put_u16(out, id_of(channels_.size()));
    put_u16(out, schema_id);
    put_string(out, channel.topic);
    put_string(out, channel.message_encoding);
    put_map(out, channel.metadata);
  }
  std::string record = as_text(std::span<const std::byte>(out).subspan(channel_begin));
  if (auto s = seal(begin, out); !s) return std::unexpected(s.error());
  if (!new_schema.empty()) schemas_.push_back(std::move(new_schema));
  channels_.push_back({std::move(record), 0});
  return static_cast<std::uint16_t>(channels_.size() - 1);
}

Status RecordingEncoder::add_metadata(const RecordingMetadata& metadata, Bytes& out) {
  check(offset_ > 0, "begin() comes first");
  const std::size_t begin = out.size();
  {
    const RecordScope record(out, kMetadata);
    put_string(out, metadata.name);
    put_map(out, metadata.values);
  }
  const MetadataExtent extent{metadata.name, offset_, out.size() - begin};
  if (auto s = seal(begin, out); !s) return s;
  metadata_.push_back(extent);
  return {};
}

Status RecordingEncoder::add_messages(std::span<const RecordingMessage> messages, Bytes& out) {
  check(offset_ > 0 && !messages.empty(), "begin() comes first, and a group has a message");
  std::size_t bytes = 0;
  for (const RecordingMessage& message : messages) {
    check(message.channel < channels_.size(), "a message goes to a channel that was added");
    bytes += kRecordHead + kMessageHead + std::min(message.data.size(), kMaxGroupBytes);
  }
  if (bytes > kMaxGroupBytes)
    return fail(Code::usage,
                fmt::format("{} bytes in one piece of a recording; at most {} fit", bytes, kMaxGroupBytes));
  const std::size_t begin = out.size();
  out.reserve(begin + bytes + kCheckBytes);
  for (const RecordingMessage& message : messages) {
    put_u8(out, kMessage);
    put_u64(out, kMessageHead + message.data.size());
    put_u16(out, id_of(message.channel));
    put_u32(out, message.sequence);
    put_u64(out, message.log_time_ns);
    put_u64(out, message.publish_time_ns);
    put_bytes(out, message.data);
  }
  if (auto s = seal(begin, out); !s) return s;
  for (const RecordingMessage& message : messages) {
    ++channels_[message.channel].messages;
    first_time_ns_ = messages_ == 0 ? message.log_time_ns : std::min(first_time_ns_, message.log_time_ns);
    last_time_ns_ = messages_ == 0 ? message.log_time_ns : std::max(last_time_ns_, message.log_time_ns);
    ++messages_;
  }
  return {};
}

void RecordingEncoder::finish(Bytes& out) {
  check(offset_ > 0, "begin() comes first");
  const std::size_t base = out.size();
  const auto here = [&] { return offset_ + (out.size() - base); };
  {
    const RecordScope record(out, kDataEnd);
    put_u32(out, 0);  // no checksum of the whole: each group has its own
  }
  const std::uint64_t summary = here();
  const std::size_t summary_begin = out.size();
  struct Extent {
    std::uint8_t op;
    std::uint64_t begin, length;
  };
  std::vector<Extent> extents;
  const auto group = [&](std::uint8_t op, auto&& write) {
    const std::uint64_t begin = here();
    write();
    if (here() > begin) extents.push_back({op, begin, here() - begin});
  };
  group(kSchema, [&] {
    for (const std::string& schema : schemas_) put_raw(out, schema);
  });
  group(kChannel, [&] {
    for (const ChannelCount& channel : channels_) put_raw(out, channel.record);
  });
  group(kStatistics, [&] {
    const RecordScope record(out, kStatistics);
    put_u64(out, static_cast<std::uint64_t>(messages_));
    put_u16(out, static_cast<std::uint16_t>(schemas_.size()));
    put_u32(out, static_cast<std::uint32_t>(channels_.size()));
    put_u32(out, 0);  // attachments
    put_u32(out, static_cast<std::uint32_t>(metadata_.size()));
    put_u32(out, 0);  // chunks
    put_u64(out, first_time_ns_);
    put_u64(out, last_time_ns_);
    put_u32(out, static_cast<std::uint32_t>(10 * channels_.size()));
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      put_u16(out, id_of(i));
      put_u64(out, channels_[i].messages);
    }
  });
  group(kMetadataIndex, [&] {
    for (const MetadataExtent& extent : metadata_) {
      const RecordScope record(out, kMetadataIndex);
      put_u64(out, extent.offset);
      put_u64(out, extent.length);
      put_string(out, extent.name);
    }
  });
  const std::uint64_t index = here();
  for (const Extent& extent : extents) {
    const RecordScope record(out, kSummaryOffset);
    put_u8(out, extent.op);
    put_u64(out, extent.begin);
    put_u64(out, extent.length);
  }
  put_u8(out, kFooter);
  put_u64(out, kFooterBytes - kRecordHead);
  put_u64(out, summary);
  put_u64(out, index);
  put_u32(out, crc32(std::span<const std::byte>(out).subspan(summary_begin)));
  put_raw(out, kMagic);
  offset_ = here();
}

}  // namespace kinemark::io
