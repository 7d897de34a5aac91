// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "kinemark/stages/report/clean_report.h"

namespace kinemark::report::internal {

/// Codes of the gap map, the worse the larger, so that a thinned point shows its worst frame: measured,
/// upsampled, interpolated, model_filled, missing, rejected.
[[nodiscard]] std::uint8_t state_rank(data::SampleState state);

/// How a gap was filled, in words: "auto: 61 % rigid; 39 % cubic", "cubic", or "" when it was left open.
[[nodiscard]] std::string how_filled(const data::GapAccount& gap);

/// Seconds from the first missing frame to the last, one frame included: 1 frame at 100 Hz is 0.01 s.
[[nodiscard]] double length_s(const data::GapAccount& gap, const TimeBase& time);

}  // namespace kinemark::report::internal
