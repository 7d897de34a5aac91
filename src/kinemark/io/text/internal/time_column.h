// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"

namespace kinemark::io::internal {

/// Place value of the last digit of a number as written, zeros after the point not counted: 0.01 for "1.250",
/// 1 for "300", 10 for "1.2e2". Zero for NaN and infinity.
[[nodiscard]] double resolution_of(std::string_view number);

/// The even time base that describes a written time column best.
///
/// A stated rate (of the header, in order of trust) is taken when the column agrees with it to half of
/// `resolution_s`, the rounding of the written times, or to 2 % of a frame. Otherwise an even column
/// determines the rate, with a warning. An uneven column gets the rate of its median step (or the stated
/// rate,
/// when they agree) and a warning that gives the largest deviation. Frame 0 is at time_s[0].
///
/// @param time_s   one or more finite times, s
/// @param stated   rates of the header in Hz; those that are not positive and finite are skipped
/// Code::bad_input when neither the column nor the header gives a rate. O(rows).
[[nodiscard]] Result<TimeBase> even_time(std::span<const double> time_s, double resolution_s,
                                         std::span<const double> stated, std::vector<std::string>& warnings);

}  // namespace kinemark::io::internal
