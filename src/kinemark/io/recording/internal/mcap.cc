// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/internal/mcap.h"

#include <xxhash.h>

#include <array>
#include <cstring>

namespace kinemark::io::internal {
namespace {

constexpr std::array<std::uint32_t, 256> kCrcTable = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int k = 0; k < 8; ++k) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1) : c >> 1;
    table[i] = c;
  }
  return table;
}();

/// Little end first, whatever the machine.
void put_number(Bytes& out, std::uint64_t v, std::size_t bytes) {
  const std::size_t at = out.size();
  out.resize(at + bytes);
  for (std::size_t i = 0; i < bytes; ++i) out[at + i] = static_cast<std::byte>(v >> (8 * i));
}

}  // namespace

std::uint64_t check_value(std::span<const std::byte> group, std::uint64_t before) {
  return XXH3_64bits_withSeed(group.data(), group.size(), before);
}

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t so_far) {
  std::uint32_t c = ~so_far;
  for (const std::byte b : bytes) c = kCrcTable[(c ^ static_cast<std::uint32_t>(b)) & 0xFFU] ^ (c >> 8);
  return ~c;
}

void put_u8(Bytes& out, std::uint8_t v) { put_number(out, v, 1); }
void put_u16(Bytes& out, std::uint16_t v) { put_number(out, v, 2); }
void put_u32(Bytes& out, std::uint32_t v) { put_number(out, v, 4); }
void put_u64(Bytes& out, std::uint64_t v) { put_number(out, v, 8); }

void put_bytes(Bytes& out, std::span<const std::byte> v) {
  const std::size_t at = out.size();
  out.resize(at + v.size());
  if (!v.empty()) std::memcpy(out.data() + at, v.data(), v.size());
}

void put_raw(Bytes& out, std::string_view v) { put_bytes(out, std::as_bytes(std::span(v))); }

void put_string(Bytes& out, std::string_view v) {
  put_u32(out, static_cast<std::uint32_t>(v.size()));
  put_raw(out, v);
}

void put_map(Bytes& out, const std::map<std::string, std::string>& v) {
  std::size_t bytes = 0;
  for (const auto& [key, value] : v) bytes += 8 + key.size() + value.size();
  put_u32(out, static_cast<std::uint32_t>(bytes));
  for (const auto& [key, value] : v) {
    put_string(out, key);
    put_string(out, value);
  }
}

RecordScope::RecordScope(Bytes& out, std::uint8_t op) : out_(out), begin_(out.size()) {
  put_u8(out, op);
  put_u64(out, 0);
}

RecordScope::~RecordScope() {
  const std::uint64_t length = out_.size() - begin_ - kRecordHead;
  for (std::size_t i = 0; i < 8; ++i) out_[begin_ + 1 + i] = static_cast<std::byte>(length >> (8 * i));
}

std::span<const std::byte> Cursor::take(std::size_t bytes) {
  if (bytes > rest_.size()) {
    good_ = false;
    rest_ = {};
    return {};
  }
  const auto taken = rest_.first(bytes);
  rest_ = rest_.subspan(bytes);
  return taken;
}

std::uint64_t Cursor::number(std::size_t bytes) {
  std::uint64_t v = 0;
  std::size_t i = 0;
  for (const std::byte b : take(bytes)) v |= static_cast<std::uint64_t>(b) << (8 * i++);
  return v;
}

std::string Cursor::string() {
  const auto text = take(u32());
  return {reinterpret_cast<const char*>(text.data()), text.size()};
}

std::map<std::string, std::string> Cursor::map() {
  Cursor entries(take(u32()));
  std::map<std::string, std::string> out;
  while (entries.good() && !entries.rest().empty()) {
    std::string key = entries.string();
    std::string value = entries.string();
    if (entries.good()) out.insert_or_assign(std::move(key), std::move(value));
  }
  good_ = good_ && entries.good();
  return out;
}

}  // namespace kinemark::io::internal
