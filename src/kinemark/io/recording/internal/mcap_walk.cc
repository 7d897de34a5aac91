// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/internal/mcap_walk.h"

#include <fmt/core.h>
#include <lz4frame.h>
#include <zstd.h>

#include <unordered_map>
#include <utility>

#include "kinemark/core/utf8.h"
#include "kinemark/io/recording/internal/mcap.h"

namespace kinemark::io::internal {
namespace {

constexpr std::uint64_t kMostUnpacked = 64UL << 20;  // bytes of a chunk; writers make chunks of 1 to 8 MB
constexpr std::uint64_t kMostRatio = 256;  // bytes in all for one of the file, beyond those of a chunk

/// Unpack one frame of zstd; false where it is damaged or of another length.
bool unpack_zstd(std::span<const std::byte> packed, Bytes& out) {
  const std::size_t n = ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size());
  return ZSTD_isError(n) == 0 && n == out.size();
}

/// The same of lz4.
bool unpack_lz4(std::span<const std::byte> packed, Bytes& out) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) return false;
  std::size_t read = 0, written = 0;
  bool good = true;
  while (good && read < packed.size()) {
    std::size_t source = packed.size() - read, target = out.size() - written;
    const std::size_t hint =
        LZ4F_decompress(context, out.data() + written, &target, packed.data() + read, &source, nullptr);
    good = LZ4F_isError(hint) == 0 && (source > 0 || target > 0);
    read += source;
    written += target;
    if (hint == 0) break;
  }
  LZ4F_freeDecompressionContext(context);
  return good && written == out.size();
}

class Walk {
 public:
  Walk(const ByteSource& source, const TakeMessage& take)
      : source_(source), take_(take), left_(kMostUnpacked + kMostRatio * source.size()) {}

  Result<McapSummary> run() {
    Bytes begin(std::min(source_.size(), kMagic.size()));
    if (auto s = read(0, begin); !s) return std::unexpected(s.error());
    if (std::string_view(reinterpret_cast<const char*>(begin.data()), begin.size()) != kMagic)
      return fail(Code::bad_input, "does not begin as an MCAP file does");
    std::uint64_t at = kMagic.size();
    Bytes content;
    while (at < source_.size()) {
      Bytes head(kRecordHead);
      if (at + kRecordHead > source_.size()) return cut(at);
      if (auto s = read(at, head); !s) return std::unexpected(s.error());
      Cursor cursor(head);
      const std::uint8_t op = cursor.u8();
      const std::uint64_t length = cursor.u64();
      if (op == kDataEnd || op == kFooter) return std::move(out_);
      if (op == 0) return fail(Code::bad_input, fmt::format("byte {}: a record of type 0 is not valid", at));
      if (length > source_.size() - at - kRecordHead) return cut(at);
      if (op == kHeader || op == kSchema || op == kChannel || op == kMessage || op == kChunk) {
        content.resize(length);
        if (auto s = read(at + kRecordHead, content); !s) return std::unexpected(s.error());
        if (auto s = record(op, content, true); !s) return fail_at(fmt::format("byte {}", at), s.error());
      }
      at += kRecordHead + length;
    }
    out_.warnings.emplace_back("the file ends without the record that ends its data: it was not closed");
    return std::move(out_);
  }

 private:
  Status read(std::uint64_t at, Bytes& out) {
    const auto n = source_.read_at(at, out);
    if (!n) return std::unexpected(n.error());
    if (*n != out.size()) return fail(Code::io, "became shorter while it was read");
    return {};
  }

  Result<McapSummary> cut(std::uint64_t at) {
    out_.warnings.push_back(
        fmt::format("the file ends within the record at byte {}; what comes before it is read", at));
    return std::move(out_);
  }

  Status record(std::uint8_t op, std::span<const std::byte> content, bool chunks) {
    Cursor cursor(content);
    switch (op) {
      case kHeader:
        out_.profile = cursor.string();
        out_.library = cursor.string();
        break;
      case kSchema: {
        const std::uint16_t id = cursor.u16();
        Schema schema{.name = cursor.string(), .encoding = cursor.string()};
        schemas_.insert_or_assign(id, std::move(schema));
        break;
      }
      case kChannel:
        return take_channel(cursor);
      case kMessage:
        return take_message(cursor);
      case kChunk:
        if (!chunks) return fail(Code::bad_input, "a chunk is in a chunk");
        return take_chunk(cursor);
      default:
        return {};
    }
    return cursor.good() ? Status() : fail(Code::bad_input, "a record is shorter than what it holds");
  }

  Status take_channel(Cursor cursor) {
    const std::uint16_t id = cursor.u16();
    const auto schema = schemas_.find(cursor.u16());
    RecordingChannel channel{.topic = cursor.string(), .message_encoding = cursor.string()};
    if (!cursor.good()) return fail(Code::bad_input, "a channel is shorter than what it holds");
    if (schema != schemas_.end()) {
      channel.schema_name = schema->second.name;
      channel.schema_encoding = schema->second.encoding;
    }
    channels_.try_emplace(id, std::move(channel));
    return {};
  }

  Status take_message(Cursor cursor) {
    RecordingMessage message{.channel = cursor.u16(), .sequence = cursor.u32()};
    message.log_time_ns = cursor.u64();
    message.publish_time_ns = cursor.u64();
    if (!cursor.good()) return fail(Code::bad_input, "a message is shorter than its head");
    message.data = cursor.rest();
    const auto channel = channels_.find(message.channel);
    if (channel == channels_.end())
      return fail(Code::bad_input,
                  fmt::format("a message is of channel {}, which is not there", message.channel));
    return take_(channel->second, message);
  }

  Status take_chunk(Cursor cursor) {
    cursor.u64();  // times of the first message and of the last
    cursor.u64();
    const std::uint64_t size = cursor.u64();
    const std::uint32_t crc = cursor.u32();
    const std::string compression = cursor.string();
    const std::uint64_t packed = cursor.u64();
    if (!cursor.good() || packed > cursor.rest().size())
      return fail(Code::bad_input, "a chunk is shorter than what it holds");
    std::span<const std::byte> records = cursor.rest().first(packed);
    Bytes unpacked;
    if (!compression.empty()) {
      if (compression != "zstd" && compression != "lz4")
        return fail(Code::not_supported, fmt::format("a chunk is compressed with '{}'; zstd and lz4 are read",
                                                     printable(compression, 40)));
      if (size > kMostUnpacked || size > left_)
        return fail(Code::bad_input,
                    fmt::format("a chunk of {} bytes says to be {} when unpacked, more than is believed",
                                packed, size));
      left_ -= size;
      unpacked.resize(size);
      if (!(compression == "zstd" ? unpack_zstd : unpack_lz4)(records, unpacked))
        return fail(Code::bad_input,
                    fmt::format("a chunk of {} cannot be unpacked; the file is damaged", compression));
      records = unpacked;
    }
    if (crc != 0 && crc32(records) != crc)
      return fail(Code::bad_input, "a chunk does not match its checksum; the file is damaged");
    while (!records.empty()) {
      Cursor head(records);
      const std::uint8_t op = head.u8();
      const std::uint64_t length = head.u64();
      if (!head.good() || length > head.rest().size())
        return fail(Code::bad_input, "a chunk ends within a record");
      if (auto s = record(op, head.rest().first(length), false); !s) return s;
      records = head.rest().subspan(length);
    }
    return {};
  }

  struct Schema {
    std::string name, encoding;
  };
  const ByteSource& source_;
  const TakeMessage& take_;
  std::uint64_t left_;  ///< bytes that chunks may still become
  McapSummary out_;
  std::unordered_map<std::uint16_t, Schema> schemas_;
  std::unordered_map<std::uint16_t, RecordingChannel> channels_;
};

}  // namespace

Result<McapSummary> walk_mcap(const ByteSource& source, const TakeMessage& take) {
  return Walk(source, take).run();
}

}  // namespace kinemark::io::internal
