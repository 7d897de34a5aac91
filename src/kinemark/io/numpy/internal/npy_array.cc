// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/numpy/internal/npy_array.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include "kinemark/core/index.h"
#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"

namespace kinemark::io::internal {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kBeforeHeader = 8, kMostHeader = 65'536, kMostAxes = 8, kMostLetters = 4096;

std::unexpected<Error> damaged_array() {
  return fail(Code::bad_input, "is no array of NumPy, or is cut short");
}

/// The header: a dictionary as Python writes it.
struct Header {
  char kind = 'f', order = '<';
  std::size_t width = 8;  // of 'U' in letters, else in bytes
  bool columns_first = false;
  std::vector<std::int64_t> shape;
};

/// What stands behind a key of the dictionary; empty: the key is not there.
std::string_view value_of(std::string_view header, std::string_view key) {
  const auto at = header.find(key);
  if (at == std::string_view::npos) return {};
  header.remove_prefix(at + key.size());
  const auto colon = header.find(':');
  if (colon == std::string_view::npos) return {};
  header.remove_prefix(colon + 1);
  const auto first = header.find_first_not_of(' ');
  return first == std::string_view::npos ? std::string_view() : header.substr(first);
}

bool read_shape(std::string_view text, std::vector<std::int64_t>& shape) {
  if (!text.starts_with('(')) return false;
  const auto close = text.find(')');
  if (close == std::string_view::npos) return false;
  text = text.substr(1, close - 1);
  while (!text.empty()) {
    const auto comma = std::min(text.find(','), text.size());
    auto cell = text.substr(0, comma);
    text.remove_prefix(std::min(comma + 1, text.size()));
    while (cell.starts_with(' ')) cell.remove_prefix(1);
    while (cell.ends_with(' ')) cell.remove_suffix(1);
    if (cell.empty()) continue;
    const auto number = parse_number(cell);
    if (!number || *number < 0.0 || *number > 1e12 || *number != std::floor(*number)) return false;
    shape.push_back(static_cast<std::int64_t>(*number));
  }
  return shape.size() <= kMostAxes;
}

Result<Header> read_header(std::string_view text) {
  const auto descr = value_of(text, "'descr'"), fortran = value_of(text, "'fortran_order'");
  Header out;
  if (!read_shape(value_of(text, "'shape'"), out.shape) ||
      (!fortran.starts_with("True") && !fortran.starts_with("False")))
    return damaged_array();
  out.columns_first = fortran.starts_with("True");
  if (!descr.starts_with('\''))
    return fail(Code::not_supported,
                "is a structured array; save positions, times and names as arrays of their own");
  const auto type = descr.substr(1, descr.substr(1).find('\''));
  if (type.size() < 2) return damaged_array();
  const bool ordered = std::string_view("<>|=").find(type.front()) != std::string_view::npos;
  if (ordered) out.order = type.front();
  out.kind = type[ordered ? 1 : 0];
  if (out.kind == 'O')
    return fail(Code::not_supported,
                "holds Python objects, which are pickled and never read; save names as numpy.array(names, "
                "dtype=str)");
  const auto width = parse_number(type.substr(ordered ? 2 : 1));
  const bool whole =
      width && *width >= 0.0 && *width <= static_cast<double>(kMostLetters) && *width == std::floor(*width);
  if (!whole || std::string_view("fiubUS").find(out.kind) == std::string_view::npos)
    return fail(Code::not_supported, fmt::format("has the type '{}'; expected numbers or texts",
                                                 printable(std::string(type), 20)));
  out.width = static_cast<std::size_t>(*width);
  const bool known = out.kind == 'f'   ? out.width == 2 || out.width == 4 || out.width == 8
                     : out.kind == 'b' ? out.width == 1
                     : out.kind == 'i' || out.kind == 'u'
                         ? out.width == 1 || out.width == 2 || out.width == 4 || out.width == 8
                         : true;
  if (!known) return fail(Code::not_supported, fmt::format("has numbers of {} bytes", out.width));
  return out;
}

std::uint64_t bits_of(std::span<const std::byte> bytes, bool big) {
  std::uint64_t out = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    out = out << 8U | std::to_integer<std::uint64_t>(bytes[big ? i : bytes.size() - 1 - i]);
  return out;
}

/// A number of half precision.
double half(std::uint64_t bits) {
  const auto exponent = static_cast<int>(bits >> 10U & 0x1fU);
  const double fraction = static_cast<double>(bits & 0x3ffU) / 1024.0,
               sign = (bits & 0x8000U) != 0 ? -1.0 : 1.0;
  if (exponent == 31) return fraction == 0.0 ? sign * INFINITY : NAN;
  return sign * (exponent == 0 ? std::ldexp(fraction, -14) : std::ldexp(1.0 + fraction, exponent - 15));
}

double number_of(const Header& header, std::span<const std::byte> bytes) {
  const auto bits = bits_of(bytes, header.order == '>');
  if (header.kind == 'f') {
    if (header.width == 2) return half(bits);
    if (header.width == 4) return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    return std::bit_cast<double>(bits);
  }
  if (header.kind != 'i') return static_cast<double>(bits);
  const auto unused = 64U - 8U * static_cast<unsigned>(header.width);
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

void append_utf8(std::string& out, std::uint64_t c) {
  if (c < 0x80) {
    out += static_cast<char>(c);
  } else if (c < 0x800) {
    out += static_cast<char>(0xc0U | c >> 6U);
    out += static_cast<char>(0x80U | (c & 0x3fU));
  } else if (c < 0x10000) {
    out += static_cast<char>(0xe0U | c >> 12U);
    out += static_cast<char>(0x80U | (c >> 6U & 0x3fU));
    out += static_cast<char>(0x80U | (c & 0x3fU));
  } else {
    out += static_cast<char>(0xf0U | (c >> 18U & 0x07U));
    out += static_cast<char>(0x80U | (c >> 12U & 0x3fU));
    out += static_cast<char>(0x80U | (c >> 6U & 0x3fU));
    out += static_cast<char>(0x80U | (c & 0x3fU));
  }
}

std::string text_of(const Header& header, std::span<const std::byte> bytes) {
  const std::size_t letter = header.kind == 'U' ? 4 : 1;
  std::string out;
  for (std::size_t at = 0; at < bytes.size(); at += letter) {
    const auto c = bits_of(bytes.subspan(at, letter), header.order == '>');
    if (c == 0) break;
    if (letter == 1)
      out += static_cast<char>(c);
    else
      append_utf8(out, c);
  }
  return name_of_bytes(out);
}

/// Place of the i-th value in the order of C among those of a file that has the first index fastest.
std::size_t place_of(std::size_t i, const std::vector<std::int64_t>& shape) {
  std::size_t place = 0, stride = 1;
  for (const auto n : shape) stride *= at(n);
  for (std::size_t axis = shape.size(); axis > 0; --axis) {
    const std::size_t n = at(shape[axis - 1]);
    stride /= n;
    place += i % n * stride;
    i /= n;
  }
  return place;
}

}  // namespace

std::int64_t NpyArray::size() const {
  std::int64_t out = 1;
  for (const auto n : shape) out *= n;
  return out;
}

Result<NpyArray> parse_npy(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with(kMagic) || bytes.size() < kBeforeHeader + 4) return damaged_array();
  const std::size_t length_bytes = bytes[6] == std::byte{1} ? 2 : 4;
  const auto length = bits_of(bytes.subspan(kBeforeHeader, length_bytes), false);
  const std::size_t begin = kBeforeHeader + length_bytes;
  if (length > kMostHeader || length > bytes.size() - begin) return damaged_array();
  const auto header = read_header(text.substr(begin, length));
  if (!header) return std::unexpected(header.error());
  const auto data = bytes.subspan(begin + length);
  const std::size_t width = header->kind == 'U' ? 4 * header->width : header->width;
  NpyArray out{.shape = header->shape, .is_text = header->kind == 'U' || header->kind == 'S'};
  // The product may not overflow before it is compared with what is there.
  std::size_t count = 1;
  const bool empty = std::ranges::find(out.shape, 0) != out.shape.end();
  for (const auto n : out.shape) {
    if (empty) break;
    if (at(n) > (data.size() + 1) / count) return damaged_array();
    count *= at(n);
  }
  if (empty) count = 0;
  if (count * width > data.size() || (width == 0 && count > data.size() + 1)) return damaged_array();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = header->columns_first ? place_of(i, out.shape) : i;
    const auto cell = data.subspan(from * width, width);
    if (out.is_text)
      out.texts.push_back(text_of(*header, cell));
    else
      out.numbers.push_back(number_of(*header, cell));
  }
  return out;
}

}  // namespace kinemark::io::internal
