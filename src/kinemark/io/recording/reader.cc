// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "kinemark/core/enum_names.h"
#include "kinemark/io/recording/internal/mcap.h"

namespace kinemark::io {
namespace {

using namespace internal;

constexpr std::size_t kWindowBytes = 4U << 20;
constexpr std::size_t kMarginBytes = 64;  ///< kept before what is asked for: a search steps back a little

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::string_view to_string(RecordingEnd end) {
  static constexpr EnumNames<RecordingEnd::damaged> kNames{"closed", "open", "cut", "damaged"};
  return kNames[end];
}

RecordingReader::RecordingReader(std::unique_ptr<ByteSource> source, const RecordingReadOptions& options)
    : source_(std::move(source)), options_(options), search_budget_(4 * source_->size() + (1U << 20)) {}

Result<RecordingReader> RecordingReader::open(const std::filesystem::path& path,
                                              const RecordingReadOptions& options) {
  auto file = InputFile::open(path);
  if (!file) return std::unexpected(file.error());
  return open(std::make_unique<FileSource>(std::move(*file)), options);
}

Result<RecordingReader> RecordingReader::open(std::unique_ptr<ByteSource> source,
                                              const RecordingReadOptions& options) {
  RecordingReader reader(std::move(source), options);
  const std::size_t there = std::min<std::size_t>(reader.source_->size(), 4096);
  const auto begin = reader.view(0, there);
  if (!begin) return std::unexpected(begin.error());
  if (there == 0) return fail(Code::bad_input, fmt::format("{}: is empty; need a recording", reader.name()));
  const bool magic = text_of(*begin).starts_with(kMagic);
  std::string profile;
  if (magic) {
    Cursor cursor(begin->subspan(kMagic.size()));
    if (cursor.u8() == kHeader && cursor.u64() < there) profile = cursor.string();
    if (!cursor.good()) profile = kProfile;  // cut or damaged there
  }
  const auto group =
      magic ? reader.scan_group(0, 0) : Group{.what = "the first bytes are not those of a recording"};
  if (!group) return std::unexpected(group.error());
  if (group->found == Found::group && profile == kProfile) return reader;
  if (options.skip_damage && group->found != Found::group) {
    if (auto s = reader.skip_damage("the header is damaged", RecordingEnd::damaged); !s)
      return std::unexpected(s.error());
    if (!reader.done_) return reader;
  }
  if (magic && profile != kProfile)
    return fail(Code::not_supported,
                fmt::format("{}: is an MCAP file of profile '{}'; only recordings of kinemark are read",
                            reader.name(), profile.substr(0, 40)));
  if (magic || kMagic.starts_with(text_of(*begin)))
    return fail(Code::bad_input, fmt::format("{}: the header of the recording is {}; nothing was read",
                                             reader.name(), group->found == Found::cut ? "cut" : "damaged"));
  return fail(Code::bad_input,
              fmt::format("{}: does not begin as a recording does (MCAP); nothing was read", reader.name()));
}

/// Bytes [offset, offset + bytes), which must lie in the file; valid until the next call.
Result<std::span<const std::byte>> RecordingReader::view(std::uint64_t offset, std::size_t bytes) {
  if (offset < window_offset_ || offset + bytes > window_offset_ + window_.size()) [[unlikely]] {
    const std::uint64_t begin = offset - std::min<std::uint64_t>(offset, kMarginBytes);
    // Twice what is asked for: a group that grows record by record is loaded few times.
    const std::size_t want = kMarginBytes + (bytes > kWindowBytes ? 2 * bytes : kWindowBytes);
    window_.resize(std::min<std::uint64_t>(want, source_->size() - begin));
    window_offset_ = begin;
    const auto n = source_->read_at(begin, window_);
    if (!n) return std::unexpected(n.error());
    if (*n != window_.size())
      return fail(Code::io, fmt::format("{}: became shorter while it was read", source_->name()));
  }
  return std::span<const std::byte>(window_).subspan(offset - window_offset_, bytes);
}

/// Follow the records from `begin` to the check record that ends their group, and compare.
Result<RecordingReader::Group> RecordingReader::scan_group(std::uint64_t begin, std::uint64_t seed) {
  const std::uint64_t size = source_->size();
  std::uint64_t at = begin + (begin == 0 ? kMagic.size() : 0);
  Group group;
  while (true) {
    group.bytes = at - begin;
    if (at == size && at == begin) return group.found = Found::end_of_file, group;
    if (at + kRecordHead > size) return group.found = Found::cut, group.what = "ends within a record", group;
    const auto bytes = view(begin, at + kRecordHead - begin);
    if (!bytes) return std::unexpected(bytes.error());
    Cursor head(bytes->subspan(at - begin));
    const std::uint8_t op = head.u8();
    const std::uint64_t length = head.u64();
    if (op == kDataEnd && at == begin) return group.found = Found::data_end, group;
    if (op == 0 || op == kFooter || op == kDataEnd || length > kMaxGroupBytes ||
        at + length - begin > kMaxGroupBytes + kRecordHead) {
      group.what =
          fmt::format("a record of type {:#04x} and {} bytes is not valid at byte {}", op, length, at);
      return group;
    }
    if (at + kRecordHead + length > size)
      return group.found = Found::cut, group.what = "ends within a record", group;
    if (op != kCheck) {
      at += kRecordHead + length;
      continue;
    }
    const auto whole = view(begin, at + kRecordHead + length - begin);
    if (!whole) return std::unexpected(whole.error());
    if (length == 8) group.check = Cursor(whole->last(8)).u64();
    if (length != 8 || check_value(whole->first(group.bytes), seed) != group.check) {
      group.what = "does not match its checksum";
      return group;
    }
    return group.found = Found::group, group;
  }
}

Result<bool> RecordingReader::next(RecordingMessage& out) {
  while (next_pending_ == pending_.size()) {
    pending_.clear();
    next_pending_ = 0;
    if (done_) return false;
    if (auto s = read_group(); !s) return std::unexpected(s.error());
  }
  out = pending_[next_pending_++];
  ++messages_;
  return true;
}

Status RecordingReader::read_group() {
  const auto group = scan_group(group_, check_);
  if (!group) return std::unexpected(group.error());
  switch (group->found) {
    case Found::end_of_file:
      done_ = true;
      return {};
    case Found::data_end:
      return read_summary();
    case Found::cut:
      return skip_damage(group->what, RecordingEnd::cut);
    case Found::damaged:
      return skip_damage(group->what, RecordingEnd::damaged);
    case Found::group:
      break;
  }
  auto records = view(group_, group->bytes);
  if (!records) return std::unexpected(records.error());
  if (group_ == 0) *records = records->subspan(kMagic.size());
  std::string what = take_records(*records);
  const std::uint64_t bytes = group->bytes + kCheckBytes;
  if (!what.empty()) {
    // Whole, but not of our making.
    pending_.clear();
    if (!options_.skip_damage) return stop(RecordingEnd::damaged, std::move(what)), Status{};
    damage_.push_back({group_, bytes, std::move(what)});
    skipped_ = true;
  }
  group_ += bytes;
  check_ = group->check;
  return {};
}

/// The empty string, or a description of the error.
std::string RecordingReader::take_records(std::span<const std::byte> records) {
  while (!records.empty()) {
    Cursor head(records);
    const std::uint8_t op = head.u8();
    const std::uint64_t length = head.u64();
    if (std::string what = take_record(op, head.rest().first(length)); !what.empty()) return what;
    records = head.rest().subspan(length);
  }
  return {};
}

std::string RecordingReader::take_record(std::uint8_t op, std::span<const std::byte> content) {
  switch (op) {
    case kMessage:
      return take_message(content);
    case kChannel:
      return take_channel(content);
    case kSchema: {
      Cursor cursor(content);
      const std::uint16_t id = cursor.u16();
      Schema schema{.name = cursor.string(), .encoding = cursor.string(), .text = cursor.string()};
      if (!cursor.good()) return "a schema is too short";
      const auto [known, is_new] = schemas_.try_emplace(id, schema);
      if (!is_new && known->second != schema) return fmt::format("schema {} is declared twice", id);
      return {};
    }
    case kMetadata: {
      Cursor cursor(content);
      RecordingMetadata metadata{.name = cursor.string(), .values = cursor.map()};
      if (!cursor.good()) return "metadata are too short";
      metadata_.push_back(std::move(metadata));
      return {};
    }
    case kHeader:
      return group_ == 0 ? std::string() : "a header in the middle";
    case kChunk:
      return "a chunk, which recordings do not have";
    default:
      return {};  // of a later version
  }
}

std::string RecordingReader::take_channel(std::span<const std::byte> content) {
  Cursor cursor(content);
  const std::uint16_t id = cursor.u16();
  const std::uint16_t schema_id = cursor.u16();
  RecordingChannel channel{.topic = cursor.string(), .message_encoding = cursor.string()};
  channel.metadata = cursor.map();
  if (!cursor.good()) return "a channel is too short";
  if (const auto schema = schemas_.find(schema_id); schema != schemas_.end()) {
    channel.schema_name = schema->second.name;
    channel.schema_encoding = schema->second.encoding;
    channel.schema_text = schema->second.text;
  } else if (schema_id != 0 && !skipped_) {
    return fmt::format("channel {} has the schema {}, which is not declared", id, schema_id);
  }
  const auto known = channel_of_id_.find(id);
  if (known != channel_of_id_.end())
    return channels_[known->second] == channel ? std::string()
                                               : fmt::format("channel {} is declared twice", id);
  if (channels_.size() == 65535) return "more than 65535 channels";
  channel_of_id_[id] = static_cast<std::uint16_t>(channels_.size());
  channels_.push_back(std::move(channel));
  return {};
}

std::string RecordingReader::take_message(std::span<const std::byte> content) {
  Cursor cursor(content);
  const std::uint16_t id = cursor.u16();
  RecordingMessage message;
  message.sequence = cursor.u32();
  message.log_time_ns = cursor.u64();
  message.publish_time_ns = cursor.u64();
  message.data = cursor.rest();
  if (!cursor.good()) return "a message is too short";
  const auto channel = channel_of_id_.find(id);
  if (channel == channel_of_id_.end())
    return fmt::format("a message on channel {}, which is not declared", id);
  message.channel = channel->second;
  pending_.push_back(message);
  return {};
}

/// From DataEnd on: complete, and matching its checksum.
Status RecordingReader::read_summary() {
  const std::uint64_t size = source_->size();
  const std::uint64_t begin = group_ + kDataEndBytes;
  if (size < begin + kFooterBytes + kMagic.size())
    return stop(RecordingEnd::cut, "ends within the summary"), Status{};
  const std::uint64_t footer = size - kMagic.size() - kFooterBytes;
  const auto data_end = view(group_, kDataEndBytes);
  if (!data_end) return std::unexpected(data_end.error());
  Cursor cursor(data_end->subspan(1));
  bool good = cursor.u64() == 4;
  good = cursor.u32() == 0 && good;
  const auto last = view(footer, kFooterBytes + kMagic.size());
  if (!last) return std::unexpected(last.error());
  if (text_of(last->last(kMagic.size())) != kMagic)
    return stop(RecordingEnd::cut, "ends within the summary"), Status{};
  Cursor end(*last);
  good = end.u8() == kFooter && good;
  good = end.u64() == kFooterBytes - kRecordHead && good;
  good = end.u64() == begin && good;
  const std::uint64_t index = end.u64();
  good = index >= begin && index <= footer && good;
  const std::uint32_t expected = end.u32();
  std::uint32_t crc = 0;
  for (std::uint64_t at = begin, stop_at = size - kMagic.size() - 4; good && at < stop_at;) {
    const auto bytes = view(at, std::min<std::uint64_t>(stop_at - at, kWindowBytes));
    if (!bytes) return std::unexpected(bytes.error());
    crc = crc32(*bytes, crc);
    at += bytes->size();
  }
  if (!good || crc != expected) return stop(RecordingEnd::damaged, "the summary is damaged"), Status{};
  group_ = size;
  done_ = true;
  end_ = RecordingEnd::closed;
  return {};
}

void RecordingReader::stop(RecordingEnd end, std::string what) {
  done_ = true;
  end_ = end;
  damage_.push_back({group_, source_->size() - group_, std::move(what)});
}

/// Leave out what begins at group_, up to where the chain of checksums can be taken up again.
Status RecordingReader::skip_damage(std::string what, RecordingEnd end) {
  if (!options_.skip_damage) return stop(end, std::move(what)), Status{};
  const auto next = find_next_group(group_);
  if (!next) return std::unexpected(next.error());
  if (*next == source_->size()) return stop(end, std::move(what)), Status{};
  damage_.push_back({group_, *next - group_, std::move(what)});
  skipped_ = true;
  group_ = *next;
  return {};
}

/// Where a group begins that follows from the check record before it (its value goes to check_), or the size
/// of the file. A check record is found by its first nine bytes; that the group after it matches is proof.
Result<std::uint64_t> RecordingReader::find_next_group(std::uint64_t from) {
  constexpr std::string_view kCheckHead("\x90\x08\0\0\0\0\0\0\0", kRecordHead);
  constexpr std::size_t kStride = 64U << 10;
  const std::uint64_t size = source_->size();
  for (std::uint64_t at = from; at + kCheckBytes <= size && search_budget_ > 0;) {
    const std::size_t n = std::min<std::uint64_t>(kStride, size - at);
    const auto bytes = view(at, n);
    if (!bytes) return std::unexpected(bytes.error());
    const std::size_t found = text_of(*bytes).find(kCheckHead);
    if (found == std::string_view::npos) {
      at += n - kRecordHead + 1;
      continue;
    }
    at += found;
    const std::uint64_t candidate = at + kCheckBytes;
    if (candidate >= size) break;
    const auto value = view(at + kRecordHead, 8);
    if (!value) return std::unexpected(value.error());
    const std::uint64_t check = Cursor(*value).u64();
    const auto group = scan_group(candidate, check);
    if (!group) return std::unexpected(group.error());
    if (group->found == Found::group || group->found == Found::data_end) {
      check_ = check;
      return candidate;
    }
    search_budget_ -= std::min<std::uint64_t>(search_budget_, group->bytes + kMarginBytes);
    ++at;
  }
  return size;
}

}  // namespace kinemark::io
