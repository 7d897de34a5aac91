// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/screening/upsampling.h"

namespace kinemark::trajectory {

/// Treatment of samples that the recorder interpolated.
enum class MadeSamples : std::uint8_t {
  mark,      ///< they stay, with state `upsampled` and a method such as "recorder, linear x4"
  missing,   ///< the same frames, but only real samples are present
  decimate,  ///< the low rate, one frame per real sample
};

/// The real samples of a recording at their true times.
///
/// `mark` and `missing` keep rate and frames and change only `measured` samples of markers that were found
/// interpolated. `decimate` divides the rate by the recording's factor f: frame k holds, for each marker, the
/// real sample among frames k f to k f + f - 1, or nothing. Its time is that of the recording's phase; where
/// a marker's real instant differs from it, sample_offset_s says so. Samples that are not `measured` keep
/// their state, and are taken over by `decimate` only where they lie on a real instant.
///
/// Nothing found: a copy. Code::not_supported when `decimate` is asked and only single markers were found
/// interpolated, or by different factors; Code::bad_input when the trajectories are invalid or the report is
/// of another recording. O(F M).
[[nodiscard]] Result<data::Trajectories> keep_real_samples(const data::Trajectories& trajectories,
                                                           const data::UpsamplingAccount& report,
                                                           MadeSamples made);

}  // namespace kinemark::trajectory
