// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A recording at another frame rate.
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::pipeline {

/// Gives a recording another frame rate, from the time of its first frame to that of its last. A new frame at
/// the time of an old one (within a thousandth of a frame) holds its samples; the others lie on cubic
/// splines through each run of present samples (ends: third derivatives from the four outer samples), are
/// SampleState::interpolated by "resampled", and have a covariance between those of their neighbours in time,
/// which is not less than theirs. Gaps stay gaps. Channels follow in the same way, angles that jump by more
/// than 180 degrees excepted. Analog samples keep their own rate where whole numbers of them fit a frame (a
/// last frame without all of its own is left out), else they are left out with the force plates; the warnings
/// say so, and that a lower rate folds what moves faster than half of it.
///
/// Code::usage for a rate that is no number from 0.001 to a million times the old one; Code::bad_input for
/// more than 2^31 samples, or samples with times of their own. O(samples).
[[nodiscard]] Status resample(data::Trial& trial, double rate_hz);

}  // namespace kinemark::pipeline
