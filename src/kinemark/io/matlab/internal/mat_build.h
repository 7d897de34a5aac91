// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Bytes of arrays as a MAT file of version 5 to 7 holds them, little endian. An array is text that larger
// ones take in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/io/matlab/internal/mat_array.h"

namespace kinemark::io::internal {

/// Sizes of an array, first fastest.
using MatDims = std::vector<std::int64_t>;
/// Fields of a struct: name (at most 31 characters) and bytes of an array.
using MatFields = std::vector<std::pair<std::string, std::string>>;

/// Numbers in the order of MATLAB (first dimension fastest), as many as `dims` says.
[[nodiscard]] std::string mat_numbers(std::span<const double> values, const MatDims& dims);
/// The same of single precision.
[[nodiscard]] std::string mat_numbers(std::span<const float> values, const MatDims& dims);
/// The same of whole numbers from 0 to 255.
[[nodiscard]] std::string mat_numbers(std::span<const std::uint8_t> values, const MatDims& dims);
/// One number.
[[nodiscard]] std::string mat_number(double value);
/// A row of characters; what is no UTF-8 is read as ISO-8859-1.
[[nodiscard]] std::string mat_text(std::string_view text);
/// A row of texts (a cellstr).
[[nodiscard]] std::string mat_texts(std::span<const std::string> texts);
/// A struct with a name, or without one as a field.
[[nodiscard]] std::string mat_struct(const MatFields& fields, std::string_view name = {});
/// A row of structs, of which each has these fields, `elements[i]` in their order.
[[nodiscard]] std::string mat_structs(const std::vector<std::string>& fields,
                                      const std::vector<std::vector<std::string>>& elements,
                                      std::string_view name = {});

/// Numbers from frame first to MATLAB's order: from (f * M + m) * K + k to f + F * (m + M * k).
template <class T>
[[nodiscard]] std::vector<T> to_columns(std::span<const T> values, std::int64_t frames, std::int64_t width,
                                        std::int64_t depth) {
  std::vector<T> out(values.size());
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 0; m < width; ++m)
      for (std::int64_t k = 0; k < depth; ++k)
        out[static_cast<std::size_t>(f + frames * (m + width * k))] =
            values[static_cast<std::size_t>((f * width + m) * depth + k)];
  return out;
}

}  // namespace kinemark::io::internal
