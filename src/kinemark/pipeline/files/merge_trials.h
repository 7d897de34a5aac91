// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Files of one recording that belong in one: parts in time, or sets of markers.
#pragma once

#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::pipeline {

/// Furthest that a sample that two files hold may lie apart, m: the digits of formats differ.
inline constexpr double kSameSample_m = 1e-4;

/// One trial of several that were recorded on one clock at one rate: frames by their numbers, markers and
/// channels by their names. What no file holds is missing; a sample that several hold is the first's. Analog
/// channels and force plates are kept where all files have the same ones without a hole between them, or one
/// file has all of its own over all frames; events that several hold are kept once; other groups of
/// parameters are the first file's. The warnings say what was left out.
///
/// Code::bad_input, naming the files: other rates or clocks, a sample that differs by more than
/// kSameSample_m, a channel of another kind or unit, frames more than ten times those recorded. O(samples).
[[nodiscard]] Result<data::Trial> merge_trials(std::vector<data::Trial> trials);

}  // namespace kinemark::pipeline
