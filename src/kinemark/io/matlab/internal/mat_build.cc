// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/matlab/internal/mat_build.h"

#include <algorithm>
#include <bit>

#include "kinemark/core/check.h"
#include "kinemark/core/utf8.h"

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kFieldBytes = 32;  // of a name, with its zero

template <class Numbers>
std::string_view bytes_of(const Numbers& values) {
  return {reinterpret_cast<const char*>(std::data(values)), std::size(values) * sizeof *std::data(values)};
}

void append_element(std::string& out, MatType type, std::string_view bytes) {
  const std::uint32_t tag[] = {std::to_underlying(type), static_cast<std::uint32_t>(bytes.size())};
  out += bytes_of(tag);
  out += bytes;
  out.append((8 - bytes.size() % 8) % 8, '\0');
}

/// Flags, dimensions and name, which every array begins with.
std::string head(MatClass kind, const MatDims& dims, std::string_view name) {
  std::string out;
  const std::uint32_t flags[] = {std::to_underlying(kind), 0};
  append_element(out, MatType::uint32, bytes_of(flags));
  const std::vector<std::int32_t> sizes(dims.begin(), dims.end());
  append_element(out, MatType::int32, bytes_of(sizes));
  append_element(out, MatType::int8, name);
  return out;
}

std::string array(const std::string& head, std::string_view rest) {
  const std::uint32_t tag[] = {std::to_underlying(MatType::matrix),
                               static_cast<std::uint32_t>(head.size() + rest.size())};
  std::string out;
  out.reserve(sizeof tag + head.size() + rest.size());
  out += bytes_of(tag);
  out += head;
  out += rest;
  return out;
}

template <class T>
std::string numbers(MatClass kind, MatType type, std::span<const T> values, const MatDims& dims) {
  std::int64_t count = 1;
  for (const std::int64_t size : dims) count *= size;
  check(std::cmp_equal(count, values.size()), "numbers of a MAT array must fill its dimensions");
  std::string out = head(kind, dims, {});
  append_element(out, type, bytes_of(values));
  return array(out, {});
}

/// UTF-8 as the units of 16 bits that MATLAB's characters are.
std::vector<std::uint16_t> units_of(std::string_view bytes) {
  const std::string text = to_utf8(bytes);
  std::vector<std::uint16_t> out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    std::uint32_t code = static_cast<unsigned char>(text[i]);
    if (length > 1) code &= 0x7FU >> length;
    for (std::size_t k = 1; k < length; ++k)
      code = code << 6U | (static_cast<unsigned char>(text[i + k]) & 0x3FU);
    if (code >= 0x10000) {
      code -= 0x10000;
      out.push_back(static_cast<std::uint16_t>(0xD800 + (code >> 10U)));
      code = 0xDC00 + (code & 0x3FFU);
    }
    out.push_back(static_cast<std::uint16_t>(code));
    i += length;
  }
  return out;
}

}  // namespace

std::string mat_numbers(std::span<const double> values, const MatDims& dims) {
  return numbers(MatClass::float64, MatType::float64, values, dims);
}

std::string mat_numbers(std::span<const float> values, const MatDims& dims) {
  return numbers(MatClass::float32, MatType::float32, values, dims);
}

std::string mat_numbers(std::span<const std::uint8_t> values, const MatDims& dims) {
  return numbers(MatClass::uint8, MatType::uint8, values, dims);
}

std::string mat_number(double value) { return mat_numbers(std::span(&value, 1), {1, 1}); }

std::string mat_text(std::string_view text) {
  const auto units = units_of(text);
  // MATLAB's '' is 0 x 0.
  return numbers(MatClass::text, MatType::uint16, std::span(units),
                 {units.empty() ? 0 : 1, static_cast<std::int64_t>(units.size())});
}

std::string mat_texts(std::span<const std::string> texts) {
  std::string rest;
  for (const std::string& text : texts) rest += mat_text(text);
  return array(head(MatClass::cell, {1, static_cast<std::int64_t>(texts.size())}, {}), rest);
}

std::string mat_structs(const std::vector<std::string>& fields,
                        const std::vector<std::vector<std::string>>& elements, std::string_view name) {
  std::string out = head(MatClass::structure, {1, static_cast<std::int64_t>(elements.size())}, name);
  const std::uint32_t width[] = {static_cast<std::uint32_t>(MatType::int32) | 4U << 16U, kFieldBytes};
  out += bytes_of(width);
  std::string names;
  for (const std::string& field : fields) {
    check(field.size() < kFieldBytes, "a field's name has at most 31 characters");
    names += field;
    names.append(kFieldBytes - field.size(), '\0');
  }
  append_element(out, MatType::int8, names);
  std::string rest;
  for (const auto& element : elements) {
    check(element.size() == fields.size(), "a struct has one array for each of its fields");
    for (const std::string& value : element) rest += value;
  }
  return array(out, rest);
}

std::string mat_struct(const MatFields& fields, std::string_view name) {
  std::vector<std::string> names, values;
  for (const auto& [field, value] : fields) {
    names.push_back(field);
    values.push_back(value);
  }
  return mat_structs(names, {values}, name);
}

}  // namespace kinemark::io::internal
