// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Does a stream's noise fill its band, or did a filter or a model make it?
#pragma once

#include <cstdint>

#include "kinemark/data/trajectories.h"
#include "kinemark/data/upsampling.h"

namespace kinemark::trajectory {

/// Spectrum of the longest complete stretch of measured samples of one marker (Welch's method: Hann windows
/// of 128 frames or the stretch if that is shorter, half overlapping, each detrended; median over
/// frequencies). low_passed: top <= 0.2 middle and top < 10 um, or nothing above the rounding. O(frames).
/// Welch (1967), IEEE Trans. Audio Electroacoust. 15(2):70-73.
[[nodiscard]] data::BandCheck check_band(const data::Trajectories& trajectories, std::int64_t marker);

}  // namespace kinemark::trajectory
