// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/numpy/internal/zip_members.h"

#include <fmt/core.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "kinemark/core/check.h"
#include "kinemark/core/utf8.h"

namespace kinemark::io::internal {
namespace {

constexpr std::uint32_t kEnd = 0x06054b50, kEnd64 = 0x06064b50, kLocator64 = 0x07064b50, kEntry = 0x02014b50,
                        kLocal = 0x04034b50;
constexpr std::size_t kEndBytes = 22, kEntryBytes = 46, kLocalBytes = 30, kLocator64Bytes = 20,
                      kEnd64Bytes = 56;
constexpr std::size_t kMostComment = 65'535;
constexpr std::size_t kMostInflated = 1032;   // bytes of one deflated byte
constexpr std::uint32_t kIn64 = 0xffffffffU;  // the number stands among the extra fields
constexpr std::uint16_t kExtra64 = 1;

std::unexpected<Error> damaged_archive() {
  return fail(Code::bad_input, "the archive is damaged or cut short");
}

/// Little-endian numbers of a span; the caller has checked that they are there.
template <class T>
T number_at(std::span<const std::byte> bytes, std::size_t at) {
  T out = 0;
  for (std::size_t i = sizeof(T); i > 0; --i)
    out = static_cast<T>(static_cast<std::uint64_t>(out) << 8U |
                         std::to_integer<std::uint64_t>(bytes[at + i - 1]));
  return out;
}

bool has(std::span<const std::byte> bytes, std::size_t at, std::size_t count) {
  return at <= bytes.size() && count <= bytes.size() - at;
}

/// Where the directory begins, and how many members it lists.
struct Directory {
  std::size_t begin = 0, members = 0;
};

std::optional<Directory> find_directory(std::span<const std::byte> archive) {
  if (archive.size() < kEndBytes) return std::nullopt;
  const std::size_t last = archive.size() - kEndBytes, first = last - std::min(last, kMostComment);
  for (std::size_t at = last + 1; at > first; --at) {
    const std::size_t end = at - 1;
    if (number_at<std::uint32_t>(archive, end) != kEnd) continue;
    Directory out{.begin = number_at<std::uint32_t>(archive, end + 16),
                  .members = number_at<std::uint16_t>(archive, end + 10)};
    if (end < kLocator64Bytes || number_at<std::uint32_t>(archive, end - kLocator64Bytes) != kLocator64)
      return out;
    const auto end64 = number_at<std::uint64_t>(archive, end - kLocator64Bytes + 8);
    if (!has(archive, end64, kEnd64Bytes) || number_at<std::uint32_t>(archive, end64) != kEnd64)
      return std::nullopt;
    return Directory{.begin = number_at<std::uint64_t>(archive, end64 + 48),
                     .members = number_at<std::uint64_t>(archive, end64 + 32)};
  }
  return std::nullopt;
}

/// Sizes of a member, and where its local header stands.
struct Place {
  std::uint64_t bytes = 0, packed = 0, local = 0;
};

/// What does not fit into 32 bits stands in an extra field, in this order.
bool read_64(std::span<const std::byte> extra, Place& place) {
  const bool needed = place.bytes == kIn64 || place.packed == kIn64 || place.local == kIn64;
  std::size_t at = 0;
  while (needed && has(extra, at, 4)) {
    const auto kind = number_at<std::uint16_t>(extra, at);
    const std::size_t size = number_at<std::uint16_t>(extra, at + 2);
    if (!has(extra, at + 4, size)) return false;
    if (kind == kExtra64) {
      const auto field = extra.subspan(at + 4, size);
      std::size_t next = 0;
      for (std::uint64_t* value : {&place.bytes, &place.packed, &place.local}) {
        if (*value != kIn64) continue;
        if (!has(field, next, 8)) return false;
        *value = number_at<std::uint64_t>(field, next);
        next += 8;
      }
      return true;
    }
    at += 4 + size;
  }
  return !needed;
}

/// The packed bytes behind a local header.
std::optional<std::span<const std::byte>> packed_bytes(std::span<const std::byte> archive,
                                                       const Place& place) {
  if (!has(archive, place.local, kLocalBytes) || number_at<std::uint32_t>(archive, place.local) != kLocal)
    return std::nullopt;
  const std::size_t name = number_at<std::uint16_t>(archive, place.local + 26),
                    extra = number_at<std::uint16_t>(archive, place.local + 28);
  const std::size_t begin = place.local + kLocalBytes + name + extra;
  if (!has(archive, begin, place.packed)) return std::nullopt;
  return archive.subspan(begin, place.packed);
}

}  // namespace

Result<std::vector<ZipMember>> zip_members(std::span<const std::byte> archive) {
  const auto directory = find_directory(archive);
  if (!directory || directory->members > archive.size() / kEntryBytes) return damaged_archive();
  std::vector<ZipMember> out;
  std::size_t at = directory->begin;
  for (std::size_t m = 0; m < directory->members; ++m) {
    if (!has(archive, at, kEntryBytes) || number_at<std::uint32_t>(archive, at) != kEntry)
      return damaged_archive();
    const auto flags = number_at<std::uint16_t>(archive, at + 8),
               method = number_at<std::uint16_t>(archive, at + 10);
    const std::size_t name = number_at<std::uint16_t>(archive, at + 28),
                      extra = number_at<std::uint16_t>(archive, at + 30),
                      comment = number_at<std::uint16_t>(archive, at + 32);
    Place place{.bytes = number_at<std::uint32_t>(archive, at + 24),
                .packed = number_at<std::uint32_t>(archive, at + 20),
                .local = number_at<std::uint32_t>(archive, at + 42)};
    if (!has(archive, at + kEntryBytes, name + extra + comment)) return damaged_archive();
    const auto* const text = reinterpret_cast<const char*>(archive.data() + at + kEntryBytes);
    ZipMember member{.name = std::string(text, name), .deflated = method == Z_DEFLATED, .packed = {}};
    if ((flags & 1U) != 0 || (method != 0 && method != Z_DEFLATED))
      return fail(Code::not_supported,
                  fmt::format("member '{}' is {}; save it again with numpy.savez", printable(member.name, 63),
                              (flags & 1U) != 0 ? "encrypted" : "packed in another way than deflate"));
    if (!read_64(archive.subspan(at + kEntryBytes + name, extra), place)) return damaged_archive();
    const auto packed = packed_bytes(archive, place);
    if (!packed) return damaged_archive();
    member.packed = *packed;
    member.bytes = place.bytes;
    out.push_back(std::move(member));
    at += kEntryBytes + name + extra + comment;
  }
  return out;
}

Result<std::vector<std::byte>> unpack(const ZipMember& member) {
  if (!member.deflated) {
    if (member.bytes != member.packed.size()) return damaged_archive();
    return std::vector<std::byte>(member.packed.begin(), member.packed.end());
  }
  constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
  if (member.bytes / kMostInflated > member.packed.size()) return damaged_archive();
  if (member.bytes > kMost || member.packed.size() > kMost)
    return fail(Code::not_supported,
                "an array of more than 4 GB; save it with numpy.savez, without compression");
  std::vector<std::byte> out(member.bytes + 1);  // one more: a stream that goes on is damaged
  z_stream stream{};
  check(inflateInit2(&stream, -MAX_WBITS) == Z_OK, "zlib cannot begin to inflate");
  // zlib does not write to its input.
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(member.packed.data()));
  stream.avail_in = static_cast<uInt>(member.packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(std::min(out.size(), kMost));
  const int status = inflate(&stream, Z_FINISH);
  const std::size_t made = stream.total_out;
  inflateEnd(&stream);
  if (status != Z_STREAM_END || made != member.bytes) return damaged_archive();
  out.resize(made);
  return out;
}

}  // namespace kinemark::io::internal
