// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Fields of a struct by name, with what they must be.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/io/matlab/internal/mat_array.h"

namespace kinemark::io::internal {

/// An array and how it is called in messages: "trial.analog".
struct MatPlace {
  const MatArray* array = nullptr;  ///< null: there is none
  std::string where;                ///< for messages

  /// A field of element `i` of a struct; no array when there is none.
  [[nodiscard]] MatPlace operator()(std::string_view field, std::int64_t i = 0) const;
  /// Whether there is an array.
  explicit operator bool() const { return array != nullptr; }

  /// One number; Code::bad_input for anything else, or nothing.
  [[nodiscard]] Result<double> number() const;
  /// A whole number from `least` to `most`.
  [[nodiscard]] Result<std::int64_t> whole(std::int64_t least, std::int64_t most) const;
  /// A text; empty where there is none.
  [[nodiscard]] std::string text() const;
  /// The texts of a cell, or one text; Code::bad_input for a cell of other things. None where there is none.
  [[nodiscard]] Result<std::vector<std::string>> texts() const;
  /// Numbers of exactly these sizes, as they lie in the file (first dimension fastest). Sizes of 1 at the end
  /// may be left out, as MATLAB does, and an array without elements may have any shape.
  [[nodiscard]] Result<Array<double>> numbers(const std::vector<std::int64_t>& dims) const;
  /// The same from 0 to 255, in the order of the library: (f * width + m) * depth + k.
  [[nodiscard]] Result<Array<std::uint8_t>> bytes(std::int64_t frames, std::int64_t width) const;
  /// numbers({frames, width, depth}) in the order of the library.
  [[nodiscard]] Result<Array<double>> frame_first(std::int64_t frames, std::int64_t width,
                                                  std::int64_t depth) const;
  /// "WHERE: what", Code::bad_input.
  [[nodiscard]] std::unexpected<Error> bad(std::string_view what) const;
};

}  // namespace kinemark::io::internal
