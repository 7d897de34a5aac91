// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/io/matlab/internal/mat_array.h"

namespace kinemark::io::internal {

inline constexpr std::size_t kMatHeaderBytes = 128;

/// The variables of a MAT file.
struct MatVariables {
  std::vector<MatArray> variables;         ///< in the order of the file; views of its bytes and of `unpacked`
  std::vector<Array<std::byte>> unpacked;  ///< what was compressed
};

/// Read the structure of a whole file of version 5 to 7, which must outlive the result. Arrays of classes
/// that are not read become MatClass::none. Code::bad_input, with the byte, for sizes that what is there does
/// not explain, more than 32 levels, a million arrays, or more compressed than read_mat() tells.
[[nodiscard]] Result<MatVariables> parse_mat_variables(std::span<const std::byte> file);

}  // namespace kinemark::io::internal
