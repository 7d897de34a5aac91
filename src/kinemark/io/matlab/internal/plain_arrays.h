// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/io/arrays/named_arrays.h"
#include "kinemark/io/matlab/internal/mat_array.h"

namespace kinemark::io::internal {

/// Arrays of numbers, texts and cells of texts, in the order of C: variables, and fields of structs of one
/// element, under the name of the field. A column and a row are of one axis, a single value of none. Others
/// are passed over.
[[nodiscard]] std::vector<NamedArray> plain_arrays(const std::vector<MatArray>& variables);

}  // namespace kinemark::io::internal
