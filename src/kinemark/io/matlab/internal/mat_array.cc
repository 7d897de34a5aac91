// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/matlab/internal/mat_array.h"

#include <algorithm>
#include <cstring>

#include "kinemark/core/utf8.h"

namespace kinemark::io::internal {
namespace {

template <class T>
T load(const std::byte* at, bool swapped) {
  std::byte raw[sizeof(T)];
  std::memcpy(raw, at, sizeof(T));
  if (swapped) std::ranges::reverse(raw);
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

template <class T>
void load_all(const MatArray& array, Array<double>& out) {
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<double>(load<T>(array.bytes.data() + i * sizeof(T), array.swapped));
}

void append_utf8(std::string& out, std::uint32_t code) {
  const auto put = [&](std::uint32_t byte) { out.push_back(static_cast<char>(byte)); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0U | code >> 6U);
    put(0x80U | (code & 0x3FU));
  } else if (code < 0x10000) {
    put(0xE0U | code >> 12U);
    put(0x80U | (code >> 6U & 0x3FU));
    put(0x80U | (code & 0x3FU));
  } else {
    put(0xF0U | code >> 18U);
    put(0x80U | (code >> 12U & 0x3FU));
    put(0x80U | (code >> 6U & 0x3FU));
    put(0x80U | (code & 0x3FU));
  }
}

/// Halves of pairs that stand alone become U+FFFD.
std::string utf8_of_utf16(const MatArray& array) {
  std::string out;
  const std::size_t units = array.bytes.size() / 2;
  const auto unit = [&](std::size_t i) -> std::uint32_t {
    return load<std::uint16_t>(array.bytes.data() + 2 * i, array.swapped);
  };
  for (std::size_t i = 0; i < units; ++i) {
    std::uint32_t code = unit(i);
    const bool high = code >= 0xD800 && code < 0xDC00;
    if (high && i + 1 < units && unit(i + 1) >= 0xDC00 && unit(i + 1) < 0xE000) {
      code = 0x10000 + ((code - 0xD800) << 10U) + (unit(++i) - 0xDC00);
    } else if (code >= 0xD800 && code < 0xE000) {
      code = 0xFFFD;
    }
    append_utf8(out, code);
  }
  return out;
}

}  // namespace

std::size_t size_of(MatType type) {
  switch (type) {
    case MatType::int8:
    case MatType::uint8:
    case MatType::utf8:
      return 1;
    case MatType::int16:
    case MatType::uint16:
    case MatType::utf16:
      return 2;
    case MatType::int32:
    case MatType::uint32:
    case MatType::float32:
      return 4;
    case MatType::float64:
    case MatType::int64:
    case MatType::uint64:
      return 8;
    default:
      return 0;
  }
}

std::int64_t MatArray::count() const {
  std::int64_t out = dims.empty() ? 0 : 1;
  for (const std::int64_t size : dims) out *= size;
  return out;
}

bool MatArray::is_numeric() const { return kind >= MatClass::float64; }

std::optional<double> MatArray::number() const {
  if (!is_numeric() || bytes.empty()) return std::nullopt;
  MatArray first;
  first.kind = kind;
  first.type = type;
  first.swapped = swapped;
  first.bytes = bytes.first(size_of(type));
  return first.numbers().front();
}

Array<double> MatArray::numbers() const {
  const std::size_t size = size_of(type);
  if (!is_numeric() || size == 0) return {};
  Array<double> out(bytes.size() / size);
  switch (type) {
    case MatType::int8:
      load_all<std::int8_t>(*this, out);
      break;
    case MatType::uint8:
      load_all<std::uint8_t>(*this, out);
      break;
    case MatType::int16:
      load_all<std::int16_t>(*this, out);
      break;
    case MatType::uint16:
      load_all<std::uint16_t>(*this, out);
      break;
    case MatType::int32:
      load_all<std::int32_t>(*this, out);
      break;
    case MatType::uint32:
      load_all<std::uint32_t>(*this, out);
      break;
    case MatType::float32:
      load_all<float>(*this, out);
      break;
    case MatType::int64:
      load_all<std::int64_t>(*this, out);
      break;
    case MatType::uint64:
      load_all<std::uint64_t>(*this, out);
      break;
    default:
      load_all<double>(*this, out);
  }
  return out;
}

std::string MatArray::text() const {
  if (kind != MatClass::text) return {};
  if (type == MatType::uint16 || type == MatType::utf16) return utf8_of_utf16(*this);
  if (size_of(type) != 1) return {};
  return to_utf8({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

const MatArray* MatArray::field(std::string_view wanted, std::int64_t i) const {
  const auto found = std::ranges::find(fields, wanted);
  const std::size_t at = static_cast<std::size_t>(i) * fields.size() + (found - fields.begin());
  if (kind != MatClass::structure || found == fields.end() || at >= elements.size()) return nullptr;
  return &elements[at];
}

}  // namespace kinemark::io::internal
