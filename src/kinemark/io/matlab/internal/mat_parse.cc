// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/matlab/internal/mat_parse.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "kinemark/io/matlab/internal/inflate.h"

namespace kinemark::io::internal {
namespace {

using Bytes = std::span<const std::byte>;

constexpr int kMostLevels = 32;
constexpr std::size_t kMostArrays = 1'000'000;
constexpr std::size_t kTagBytes = 8;
constexpr std::size_t kMostUnpacked = 256UL << 20;  // and kUnpackedPerByte for each byte of the file
constexpr std::size_t kUnpackedPerByte = 64;
constexpr std::uint32_t kComplex = 0x0800;

/// A tagged piece of a file.
struct Element {
  MatType type = MatType::none;
  Bytes bytes;
};

/// Walks over elements one after the other.
class Elements {
 public:
  Elements(Bytes bytes, bool swapped) : rest_(bytes), swapped_(swapped), size_(bytes.size()) {}

  [[nodiscard]] bool empty() const { return rest_.size() < kTagBytes; }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }
  [[nodiscard]] std::size_t place() const { return size_ - rest_.size(); }

  Result<Element> next() {
    if (empty()) return fail(Code::bad_input, "an array is cut short");
    const std::uint32_t head = word(0);
    const std::size_t small = head >> 16U;
    if (small > 4)
      return fail(Code::bad_input, fmt::format("a short element of {} bytes; need at most 4", small));
    const std::size_t size = small != 0 ? small : word(4);
    const auto type = static_cast<MatType>(small != 0 ? head & 0xFFU : std::min<std::uint32_t>(head, 255));
    const std::size_t begin = small != 0 ? 4 : kTagBytes;
    if (size > rest_.size() - begin)
      return fail(Code::bad_input,
                  fmt::format("an element of {} bytes where {} are left", size, rest_.size() - begin));
    Element out{.type = type, .bytes = rest_.subspan(begin, size)};
    std::size_t end = small != 0 ? kTagBytes : begin + size;
    if (type != MatType::compressed) end = (end + 7) / 8 * 8;
    rest_ = rest_.subspan(std::min(end, rest_.size()));
    return out;
  }

 private:
  [[nodiscard]] std::uint32_t word(std::size_t at) const {
    std::uint32_t out = 0;
    std::memcpy(&out, rest_.data() + at, sizeof out);
    return swapped_ ? __builtin_bswap32(out) : out;
  }

  Bytes rest_;
  bool swapped_;
  std::size_t size_;
};

class Parser {
 public:
  explicit Parser(bool swapped) : swapped_(swapped) {}

  /// The content of a matrix element.
  Result<MatArray> matrix(Bytes bytes, int level) {
    if (level > kMostLevels)
      return fail(Code::bad_input, fmt::format("arrays lie in arrays more than {} times", kMostLevels));
    if (++arrays_ > kMostArrays)
      return fail(Code::bad_input, fmt::format("the file holds more than {} arrays", kMostArrays));
    MatArray out;
    out.swapped = swapped_;
    if (bytes.empty()) {  // as MATLAB writes an empty array
      out.kind = MatClass::float64;
      out.dims = {0, 0};
      return out;
    }
    Elements in(bytes, swapped_);
    std::uint32_t flags = 0;
    if (auto s = read_head(in, flags, out); !s) return std::unexpected(s.error());
    if (out.kind == MatClass::none) return out;
    const bool nested = out.kind == MatClass::cell || out.kind == MatClass::structure;
    const auto s = nested ? read_elements(in, level, out) : read_numbers(in, flags, out);
    if (!s) return std::unexpected(s.error());
    return out;
  }

 private:
  Result<std::vector<std::uint32_t>> words(Elements& in, MatType type, MatType or_type) const {
    const auto element = in.next();
    if (!element) return std::unexpected(element.error());
    if ((element->type != type && element->type != or_type) || element->bytes.size() % 4 != 0)
      return fail(Code::bad_input, fmt::format("an array begins with an element of type {}",
                                               std::to_underlying(element->type)));
    std::vector<std::uint32_t> out(element->bytes.size() / 4);
    if (!out.empty()) std::memcpy(out.data(), element->bytes.data(), element->bytes.size());
    if (swapped_)
      for (std::uint32_t& word : out) word = __builtin_bswap32(word);
    return out;
  }

  static Result<std::string> text(Elements& in) {
    const auto element = in.next();
    if (!element) return std::unexpected(element.error());
    if (size_of(element->type) != 1) return fail(Code::bad_input, "a name that is no text");
    return std::string(reinterpret_cast<const char*>(element->bytes.data()), element->bytes.size());
  }

  /// Flags, dimensions and name; of a class that is not read, the class alone.
  Status read_head(Elements& in, std::uint32_t& flags, MatArray& out) const {
    const auto head = words(in, MatType::uint32, MatType::int32);
    if (!head) return std::unexpected(head.error());
    if (head->empty()) return fail(Code::bad_input, "an array without a class");
    flags = head->front();
    const auto number = static_cast<std::uint8_t>(flags & 0xFFU);
    const bool known = number <= 15 && number != 0 && number != 3 && number != 5;
    if (!known) return {};
    const auto dims = words(in, MatType::int32, MatType::uint32);
    if (!dims) return std::unexpected(dims.error());
    if (dims->size() < 2 || dims->size() > 16)
      return fail(Code::bad_input, fmt::format("an array of {} dimensions; need 2 to 16", dims->size()));
    std::int64_t count = 1;
    for (const std::uint32_t size : *dims) {
      if (size > 0x7FFFFFFF || __builtin_mul_overflow(count, std::int64_t{size}, &count))
        return fail(Code::bad_input, "an array of more elements than can be counted");
      out.dims.push_back(size);
    }
    auto name = text(in);
    if (!name) return std::unexpected(name.error());
    out.name = std::move(*name);
    out.kind = static_cast<MatClass>(number);
    return {};
  }

  static Status read_numbers(Elements& in, std::uint32_t flags, MatArray& out) {
    if (in.empty() && out.count() == 0) return {};
    const auto element = in.next();
    if (!element) return std::unexpected(element.error());
    const std::size_t size = size_of(element->type);
    const bool is_text = element->type == MatType::utf8 || element->type == MatType::utf16;
    if (size == 0 || (is_text && out.kind != MatClass::text))
      return fail(Code::bad_input, fmt::format("numbers of type {}", std::to_underlying(element->type)));
    // Characters of more than one byte make fewer than there are bytes.
    const bool fits =
        element->type == MatType::utf8 ||
        (element->bytes.size() % size == 0 && std::cmp_equal(element->bytes.size() / size, out.count()));
    if (!fits)
      return fail(Code::bad_input, fmt::format("an array of {} elements holds {} bytes of {} each",
                                               out.count(), element->bytes.size(), size));
    // Of complex numbers the imaginary parts follow; nothing here is complex.
    if ((flags & kComplex) != 0) {
      out.kind = MatClass::none;
      return {};
    }
    out.type = element->type;
    out.bytes = element->bytes;
    return {};
  }

  Status read_fields(Elements& in, MatArray& out) const {
    const auto width = words(in, MatType::int32, MatType::uint32);
    if (!width) return std::unexpected(width.error());
    const auto names = text(in);
    if (!names) return std::unexpected(names.error());
    const std::size_t each = width->empty() ? 0 : width->front();
    if (each == 0 || names->size() % each != 0)
      return fail(Code::bad_input,
                  fmt::format("names of fields in {} bytes of {} each", names->size(), each));
    for (std::size_t at = 0; at < names->size(); at += each)
      out.fields.emplace_back(names->substr(at, std::min(each, names->find('\0', at) - at)));
    return {};
  }

  Status read_elements(Elements& in, int level, MatArray& out) {
    auto count = static_cast<std::uint64_t>(out.count());
    if (out.kind == MatClass::structure) {
      if (auto s = read_fields(in, out); !s) return s;
      if (__builtin_mul_overflow(count, out.fields.size(), &count)) count = ~0UL;
    }
    if (count > in.left() / kTagBytes)
      return fail(Code::bad_input, fmt::format("an array of {} arrays in {} bytes", count, in.left()));
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto element = in.next();
      if (!element) return std::unexpected(element.error());
      if (element->type != MatType::matrix)
        return fail(Code::bad_input, fmt::format("an element of type {} where an array belongs",
                                                 std::to_underlying(element->type)));
      auto array = matrix(element->bytes, level + 1);
      if (!array) return std::unexpected(array.error());
      out.elements.push_back(std::move(*array));
    }
    return {};
  }

  bool swapped_;
  std::size_t arrays_ = 0;
};

/// What a compressed element holds: one matrix element.
Result<Array<std::byte>> unpack(Bytes packed, bool swapped, std::size_t& budget) {
  std::uint32_t tag[2] = {};
  if (auto s = inflate_start(packed, std::as_writable_bytes(std::span(tag))); !s)
    return std::unexpected(s.error());
  const std::size_t size = kTagBytes + (swapped ? __builtin_bswap32(tag[1]) : tag[1]);
  if (size > budget)
    return fail(Code::bad_input,
                fmt::format("{} bytes are compressed in a file that explains {}", size, budget));
  budget -= size;
  return inflate_all(packed, size);
}

}  // namespace

Result<MatVariables> parse_mat_variables(Bytes file) {
  if (file.size() < kMatHeaderBytes)
    return fail(Code::bad_input, "a MAT file begins with 128 bytes; these are fewer");
  const bool swapped = file[126] == std::byte{'M'};
  std::size_t budget = kMostUnpacked + kUnpackedPerByte * file.size();
  MatVariables out;
  Parser parser(swapped);
  Elements in(file.subspan(kMatHeaderBytes), swapped);
  while (!in.empty()) {
    const std::size_t place = kMatHeaderBytes + in.place();
    const auto at = [&](const Error& error) { return fail_at(fmt::format("byte {}", place), error); };
    auto element = in.next();
    if (!element) return at(element.error());
    if (element->type == MatType::compressed) {
      auto bytes = unpack(element->bytes, swapped, budget);
      if (!bytes) return at(bytes.error());
      out.unpacked.push_back(std::move(*bytes));
      element = Elements(out.unpacked.back(), swapped).next();
      if (!element) return at(element.error());
    }
    if (element->type != MatType::matrix) continue;
    auto array = parser.matrix(element->bytes, 0);
    if (!array) return at(array.error());
    out.variables.push_back(std::move(*array));
  }
  return out;
}

}  // namespace kinemark::io::internal
