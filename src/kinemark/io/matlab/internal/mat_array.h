// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/array.h"

namespace kinemark::io::internal {

/// What an array is to MATLAB; the numbers are the file's.
enum class MatClass : std::uint8_t {
  none = 0,
  cell = 1,
  structure = 2,
  text = 4,
  float64 = 6,
  float32 = 7,
  int8 = 8,
  uint8 = 9,
  int16 = 10,
  uint16 = 11,
  int32 = 12,
  uint32 = 13,
  int64 = 14,
  uint64 = 15,
};

/// How numbers lie in the file, which may be narrower than their class; the numbers are the file's.
enum class MatType : std::uint8_t {
  none = 0,
  int8 = 1,
  uint8 = 2,
  int16 = 3,
  uint16 = 4,
  int32 = 5,
  uint32 = 6,
  float32 = 7,
  float64 = 9,
  int64 = 12,
  uint64 = 13,
  matrix = 14,
  compressed = 15,
  utf8 = 16,
  utf16 = 17,
};

/// Bytes of a number; 0 of what is no number.
[[nodiscard]] std::size_t size_of(MatType type);

/// An array of a MAT file, of which the numbers are views of bytes that someone else keeps.
struct MatArray {
  std::string name;                  ///< of a variable; empty in cells and fields
  MatClass kind = MatClass::none;    ///< none: a class that is not read (objects, sparse arrays)
  std::vector<std::int64_t> dims;    ///< two or more, first fastest
  MatType type = MatType::none;      ///< of the numbers
  bool swapped = false;              ///< they are in the other byte order
  std::span<const std::byte> bytes;  ///< the numbers, or the text
  std::vector<std::string> fields;   ///< of a struct
  std::vector<MatArray> elements;  ///< of a cell; of a struct, the fields of its first element, then the next

  /// Elements by the dimensions; 0 without any.
  [[nodiscard]] std::int64_t count() const;
  /// Size along a dimension, from 0; 1 beyond the last.
  [[nodiscard]] std::int64_t dim(std::size_t i) const { return i < dims.size() ? dims[i] : 1; }
  /// True of numbers: not text, not cells.
  [[nodiscard]] bool is_numeric() const;
  /// The first number, or nothing when there is none.
  [[nodiscard]] std::optional<double> number() const;
  /// All numbers in the order of the file. A whole number of 64 bits beyond 2^53 is rounded.
  [[nodiscard]] Array<double> numbers() const;
  /// The characters as UTF-8; empty when it is no text. Several rows come column by column.
  [[nodiscard]] std::string text() const;
  /// Field `name` of element `i` of a struct; null where there is none.
  [[nodiscard]] const MatArray* field(std::string_view name, std::int64_t i = 0) const;
};

}  // namespace kinemark::io::internal
