// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/matlab/internal/mat_array.h"

namespace kinemark::io::internal {

/// Whether an array is a struct as Qualisys Track Manager exports one: with Trajectories and FrameRate.
[[nodiscard]] bool is_qtm_struct(const MatArray& array);

/// The trial in it, with neither source nor format; what is left out stands among the warnings.
/// Code::bad_input, naming the field, where sizes or numbers contradict each other.
[[nodiscard]] Result<data::Trial> read_qtm_struct(const MatArray& array);

}  // namespace kinemark::io::internal
