// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/matlab/internal/inflate.h"

#include <zlib.h>

#include <algorithm>

#include "kinemark/core/check.h"

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 30;  // zlib counts in 32 bits

/// zlib's state, which it must be asked to free.
struct Inflating {
  z_stream stream{};
  Inflating() { check(inflateInit(&stream) == Z_OK, "zlib cannot begin to inflate"); }
  ~Inflating() { inflateEnd(&stream); }
  Inflating(const Inflating&) = delete;
  Inflating& operator=(const Inflating&) = delete;
};

std::unexpected<Error> damaged() { return fail(Code::bad_input, "compressed data are damaged or cut short"); }

}  // namespace

Status inflate_start(std::span<const std::byte> packed, std::span<std::byte> out) {
  Inflating in;
  std::size_t used = 0, made = 0;
  while (made < out.size()) {
    const std::size_t give = std::min(packed.size() - used, kPiece),
                      take = std::min(out.size() - made, kPiece);
    // zlib does not write to its input.
    in.stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed.data() + used));
    in.stream.avail_in = static_cast<uInt>(give);
    in.stream.next_out = reinterpret_cast<Bytef*>(out.data() + made);
    in.stream.avail_out = static_cast<uInt>(take);
    const int status = inflate(&in.stream, Z_NO_FLUSH);
    const std::size_t read = give - in.stream.avail_in, written = take - in.stream.avail_out;
    used += read;
    made += written;
    if (status == Z_STREAM_END) break;
    if (status != Z_OK || (read == 0 && written == 0)) return damaged();
  }
  if (made < out.size()) return damaged();
  return {};
}

Result<Array<std::byte>> inflate_all(std::span<const std::byte> packed, std::size_t size) {
  // One byte of deflate makes 1032 at most.
  if (size / 1032 > packed.size()) return damaged();
  Array<std::byte> out(size);
  if (auto s = inflate_start(packed, out); !s) return std::unexpected(s.error());
  return out;
}

Array<std::byte> deflate_all(std::span<const std::byte> bytes) {
  uLongf size = compressBound(bytes.size());
  Array<std::byte> out(size);
  // Coordinates hardly shrink; the fastest level takes off what can be.
  const int status = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_SPEED);
  check(status == Z_OK, "zlib cannot deflate");
  out.resize(size);
  return out;
}

}  // namespace kinemark::io::internal
