// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io {

/// Times with the clock's offsets added: the line through them where there are two or more, none where there
/// is none. @param offsets  when, and what is to be added, s
void correct_clock(std::span<const std::pair<double, double>> offsets, std::vector<double>& time_s);

/// Even frames of samples that came with jitter and gaps.
struct SampleClock {
  double rate_hz = 0.0;             ///< of the frames
  double start_s = 0.0;             ///< of frame 0, on the clock of the samples
  std::vector<std::int64_t> frame;  ///< of each sample, increasing from 0
  std::int64_t dropped = 0;         ///< frames without a sample
  double widest_gap_s = 0.0;        ///< among those; 0: none
};

/// Frames of N samples by their times: a step of more than one and a half frames, and six standard deviations
/// (robust) of the steps more, is a gap of whole frames. The rate is the nominal one where the line through
/// the times keeps to it within half a frame over the recording, else that of the line. NaN is a sample at
/// the step after the one before. Code::bad_input: fewer than two samples without a nominal rate, times that
/// go back, no rate, more than 10 dropped frames for each sample.
/// @param nominal_hz  0: the median step tells
[[nodiscard]] Result<SampleClock> find_clock(std::vector<double> time_s, double nominal_hz);

}  // namespace kinemark::io
