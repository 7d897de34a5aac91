// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/matlab/internal/struct_fields.h"

namespace kinemark::io::internal {

/// The version of our struct, in its field `kinemark`.
inline constexpr double kMatStruct = 1.0;

/// Names of the states, by their numbers in the field `status`.
[[nodiscard]] std::vector<std::string> mat_state_names();

/// Whether an array is a struct of write_mat().
[[nodiscard]] bool is_own_struct(const MatArray& array);

/// The trial in it, with neither source nor format. Code::bad_input, naming the field, where a size or a
/// number is not as write_mat() leaves it; Code::not_supported for a newer version of the struct.
[[nodiscard]] Result<data::Trial> read_own_struct(const MatArray& array);

}  // namespace kinemark::io::internal
