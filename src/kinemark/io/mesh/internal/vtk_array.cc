// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/mesh/internal/vtk_array.h"

#include <fmt/core.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"

#include "kinemark/io/mesh/internal/words.h"

namespace kinemark::io::internal {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes are taken as they stand");

constexpr std::size_t kMostBlocks = 1U << 20;
constexpr std::uint8_t kNone = 255;

std::unexpected<Error> damaged(std::string_view what) {
  return fail(Code::bad_input, fmt::format("the bytes of an array are damaged or cut short: {}", what));
}

std::uint8_t sextet(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<std::uint8_t>(c - 'A');
  if (c >= 'a' && c <= 'z') return static_cast<std::uint8_t>(c - 'a' + 26);
  if (c >= '0' && c <= '9') return static_cast<std::uint8_t>(c - '0' + 52);
  return c == '+' ? 62 : c == '/' ? 63 : kNone;
}

/// Bytes one after the other, from base64 or as they stand.
class Bytes {
 public:
  Bytes(std::string_view text, bool is_raw) : text_(text), is_raw_(is_raw) {}

  /// The next `count` bytes; with base64 they are encoded by themselves, up to a multiple of three.
  Result<std::string> take(std::size_t count) {
    if (is_raw_) {
      if (text_.size() < count) return damaged(fmt::format("{} of {} bytes", text_.size(), count));
      std::string out(text_.substr(0, count));
      text_.remove_prefix(count);
      return out;
    }
    if (text_.size() / 4 < count / 3) return damaged(fmt::format("need {} bytes", count));
    std::string out;
    out.reserve(count + 2);
    while (out.size() < count)
      if (auto s = take_group(out); !s) return std::unexpected(s.error());
    out.resize(count);
    return out;
  }
  /// The same, which are taken once more later.
  Result<std::string> peek(std::size_t count) {
    Bytes copy = *this;
    return copy.take(count);
  }

 private:
  /// Four letters, three bytes.
  Status take_group(std::string& out) {
    if (text_.size() < 4) return damaged("base64 ends early");
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint8_t six = text_[i] == '=' && i > 1 ? 0 : sextet(text_[i]);
      if (six == kNone) return damaged("a letter that is none of base64's");
      bits = bits << 6 | six;
    }
    for (int shift = 16; shift >= 0; shift -= 8) out.push_back(static_cast<char>(bits >> shift));
    text_.remove_prefix(4);
    return {};
  }

  std::string_view text_;
  bool is_raw_;
};

std::uint64_t header_at(const std::string& bytes, std::size_t index, bool wide) {
  std::uint64_t value = 0;
  const std::size_t size = wide ? 8 : 4;
  std::memcpy(&value, bytes.data() + index * size, size);
  return value;
}

/// Bytes ahead of which stands how many they are.
Result<std::string> plain_bytes(const VtkFile& file, Bytes bytes, std::size_t most) {
  const std::size_t width = file.wide_headers ? 8 : 4;
  const auto head = bytes.peek(width);
  if (!head) return std::unexpected(head.error());
  const std::uint64_t size = header_at(*head, 0, file.wide_headers);
  if (size > most)
    return fail(Code::bad_input, fmt::format("an array has {} bytes; at most {} are read", size, most));
  auto all = bytes.take(width + size);
  if (!all) return all;
  return all->substr(width);
}

/// Blocks that were packed, each by itself: how many, their size, that of the last one, and that of each when
/// packed.
Result<std::string> packed_bytes(const VtkFile& file, Bytes bytes, std::size_t most) {
  const std::size_t width = file.wide_headers ? 8 : 4;
  const auto first = bytes.peek(width);
  if (!first) return std::unexpected(first.error());
  const std::uint64_t blocks = header_at(*first, 0, file.wide_headers);
  if (blocks > kMostBlocks) return damaged(fmt::format("{} blocks", blocks));
  const auto head = bytes.take(width * (3 + blocks));
  if (!head) return std::unexpected(head.error());
  const auto number = [&](std::size_t i) { return header_at(*head, i, file.wide_headers); };
  std::uint64_t packed = 0;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    if (number(3 + b) > most) return damaged("a block longer than the file");
    packed += number(3 + b);
  }
  if (packed > most) return damaged("blocks longer than the file");
  const auto body = bytes.take(packed);
  if (!body) return std::unexpected(body.error());
  std::string out;
  std::size_t at = 0;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::uint64_t size = b + 1 == blocks && number(2) > 0 ? number(2) : number(1);
    const std::uint64_t length = number(3 + b);
    // One byte of deflate makes 1032 at most.
    if (size > most - out.size() || size / 1032 > length) return damaged("a block too large when unpacked");
    auto made = static_cast<uLongf>(size);
    const std::size_t before = out.size();
    out.resize(before + size);
    if (uncompress(reinterpret_cast<Bytef*>(out.data() + before), &made,
                   reinterpret_cast<const Bytef*>(body->data() + at), length) != Z_OK ||
        made != size)
      return damaged("zlib cannot unpack it");
    at += length;
  }
  return out;
}

template <class T>
std::vector<double> numbers_as(const std::string& bytes) {
  std::vector<double> out(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < out.size(); ++i) {
    T value;
    std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
    out[i] = static_cast<double>(value);
  }
  return out;
}

struct NumberType {
  std::string_view name;
  std::size_t size;
  std::vector<double> (*decode)(const std::string&);
};

constexpr std::array kTypes = {
    NumberType{"Float32", 4, numbers_as<float>},        NumberType{"Float64", 8, numbers_as<double>},
    NumberType{"Int32", 4, numbers_as<std::int32_t>},   NumberType{"Int64", 8, numbers_as<std::int64_t>},
    NumberType{"UInt32", 4, numbers_as<std::uint32_t>}, NumberType{"UInt64", 8, numbers_as<std::uint64_t>},
    NumberType{"Int16", 2, numbers_as<std::int16_t>},   NumberType{"UInt16", 2, numbers_as<std::uint16_t>},
    NumberType{"Int8", 1, numbers_as<std::int8_t>},     NumberType{"UInt8", 1, numbers_as<std::uint8_t>},
};

Result<std::vector<double>> from_words(std::string_view text, std::size_t most) {
  std::vector<double> out;
  Words words(text);
  for (auto word = words.next(); !word.empty(); word = words.next()) {
    const auto number = parse_number(word);
    if (!number)
      return fail(Code::bad_input,
                  fmt::format("number {} of an array is \"{}\"", out.size() + 1, printable(word, 20)));
    if (out.size() >= most)
      return fail(Code::bad_input, fmt::format("an array has more than {} numbers", most));
    out.push_back(*number);
  }
  return out;
}

}  // namespace

Result<VtkFile> vtk_file_of(pugi::xml_node root) {
  VtkFile file;
  const std::string_view order = root.attribute("byte_order").as_string("LittleEndian");
  if (order != "LittleEndian")
    return fail(Code::not_supported,
                fmt::format("its byte_order is \"{}\"; LittleEndian is read", printable(order, 40)));
  file.wide_headers = std::string_view(root.attribute("header_type").value()) == "UInt64";
  const std::string_view packer = root.attribute("compressor").value();
  file.packed = !packer.empty();
  if (file.packed && packer != "vtkZLibDataCompressor")
    return fail(Code::not_supported,
                fmt::format("it is packed by {}; vtkZLibDataCompressor is read", printable(packer, 60)));
  return file;
}

Result<std::vector<double>> read_vtk_array(const VtkFile& file, pugi::xml_node array, std::size_t most) {
  const std::string_view format = array.attribute("format").as_string("ascii");
  if (format == "ascii") return from_words(array.text().get(), most);
  if (format != "binary" && format != "appended")
    return fail(Code::not_supported, fmt::format("the format of an array is \"{}\"; ascii, binary and "
                                                 "appended are read",
                                                 printable(format, 40)));
  const std::string_view wanted = array.attribute("type").value();
  const auto type = std::ranges::find(kTypes, wanted, &NumberType::name);
  if (type == kTypes.end())
    return fail(Code::not_supported,
                fmt::format("the numbers of an array are of type \"{}\"", printable(wanted, 40)));
  std::string_view text = trim(array.text().get());
  text.remove_prefix(std::min(text.size(), text.find_first_not_of(" \t\r\n")));
  const bool appended = format == "appended";
  if (appended) {
    const std::uint64_t offset = array.attribute("offset").as_ullong();
    if (offset >= file.appended.size()) return damaged("an offset behind the end of what is appended");
    text = file.appended.substr(offset);
  }
  const Bytes bytes(text, appended && file.appended_raw);
  const auto decoded = file.packed ? packed_bytes(file, bytes, most * type->size)
                                   : plain_bytes(file, bytes, most * type->size);
  if (!decoded) return std::unexpected(decoded.error());
  return type->decode(*decoded);
}

}  // namespace kinemark::io::internal
