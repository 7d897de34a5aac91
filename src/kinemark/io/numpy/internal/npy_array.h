// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One array of NumPy: the bytes of an .npy file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io::internal {

/// An array in the order of C, the last index fastest: of numbers, or of texts.
struct NpyArray {
  std::vector<std::int64_t> shape;  ///< empty: one value
  std::vector<double> numbers;      ///< as many as the shape says; empty for texts
  std::vector<std::string> texts;   ///< as many as the shape says, UTF-8; empty for numbers
  bool is_text = false;             ///< of which there are none in an empty array

  /// Product of the shape.
  [[nodiscard]] std::int64_t size() const;
};

/// Read an array: numbers (f2, f4, f8, i1 to i8, u1 to u8, b1) or texts (U, S), of either order of bytes.
/// Code::not_supported for pickled objects and other types, saying what to save instead; Code::bad_input for
/// what is damaged.
[[nodiscard]] Result<NpyArray> parse_npy(std::span<const std::byte> bytes);

}  // namespace kinemark::io::internal
