// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// All that is known of samples, moved together: position, state, covariance, method, time, residual, cameras.
#pragma once

#include <cstdint>
#include <string>

#include "kinemark/data/trial.h"
#include "kinemark/stages/trajectory/edits/part_of_trial.h"

namespace kinemark::trajectory::internal {

/// Exchange the samples of two markers. Sample times that are one per marker become one per sample where they
/// differ; gather_times() takes that back.
void swap_samples(data::Trial& trial, std::int64_t a, std::int64_t b, const FrameSpan& frames);

/// Move the present samples of a marker to another, which has none in these frames; `from` is missing there.
void move_samples(data::Trial& trial, std::int64_t from, std::int64_t to, const FrameSpan& frames);

/// Take one sample away: missing or rejected, with nothing known of it but its time.
void blank_sample(data::Trial& trial, std::int64_t frame, std::int64_t marker, data::SampleState why);

/// Nothing is known any more of a sample's cameras: it was made.
void forget_cameras(data::Trial& trial, std::int64_t frame, std::int64_t marker);

/// A marker without samples behind the others, measured at the times of the marker `like`.
void add_marker(data::Trial& trial, const std::string& name, std::int64_t like);

/// Times that are the same in every frame become one per marker again.
void gather_times(data::Trajectories& markers);

}  // namespace kinemark::trajectory::internal
