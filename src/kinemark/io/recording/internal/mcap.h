// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The few parts of MCAP (https://mcap.dev/spec) that a recording is made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "kinemark/io/recording/recording.h"

namespace kinemark::io::internal {

inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
inline constexpr std::string_view kProfile = "kinemark";
inline constexpr std::size_t kRecordHead = 9;  ///< operation code and length of the content

enum Op : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
  kCheck = 0x90,  ///< ours, in the range that MCAP leaves to applications
};

inline constexpr std::size_t kCheckBytes = kRecordHead + 8;
inline constexpr std::size_t kDataEndBytes = kRecordHead + 4;
inline constexpr std::size_t kFooterBytes = kRecordHead + 8 + 8 + 4;
inline constexpr std::size_t kMessageHead = 2 + 4 + 8 + 8;

/// Value of the check record after `group`, when the check before it is `before` (0 at the file's start).
[[nodiscard]] std::uint64_t check_value(std::span<const std::byte> group, std::uint64_t before);

/// CRC-32 as in zlib; `so_far` is what earlier bytes gave.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t so_far = 0);

void put_u8(Bytes& out, std::uint8_t v);
void put_u16(Bytes& out, std::uint16_t v);
void put_u32(Bytes& out, std::uint32_t v);
void put_u64(Bytes& out, std::uint64_t v);
void put_bytes(Bytes& out, std::span<const std::byte> v);
void put_raw(Bytes& out, std::string_view v);
void put_string(Bytes& out, std::string_view v);
void put_map(Bytes& out, const std::map<std::string, std::string>& v);

/// Writes the head of a record now and its length at the end of the scope.
class RecordScope {
 public:
  RecordScope(Bytes& out, std::uint8_t op);
  ~RecordScope();
  RecordScope(const RecordScope&) = delete;
  RecordScope& operator=(const RecordScope&) = delete;

 private:
  Bytes& out_;
  std::size_t begin_;
};

/// Takes numbers and texts from the front of bytes. When there are too few, what is taken is empty or 0 and
/// good() is false from then on.
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes) : rest_(bytes) {}
  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }
  std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() { return number(8); }
  std::string string();
  std::map<std::string, std::string> map();

 private:
  std::span<const std::byte> take(std::size_t bytes);
  std::uint64_t number(std::size_t bytes);
  std::span<const std::byte> rest_;
  bool good_ = true;
};

}  // namespace kinemark::io::internal
