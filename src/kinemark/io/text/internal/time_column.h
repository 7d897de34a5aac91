// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a written column of times says, and what it may not say: one rule for every text with frames.
#pragma once

#include <cstdint>
#include <functional>
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

/// A time column and what is known of it.
struct TimeColumn {
  std::span<const double> time_s;  ///< of each row, one or more, finite
  double resolution_s = 0.0;       ///< place value of their last digit
  std::span<const double>
      stated;  ///< rates of the header, Hz, in order of trust; what is_rate() refuses is skipped
  std::int64_t most_frames = 0;  ///< how many frames may be made of it
  /// Where a row stands, for messages: "line 57 (frame 51)".
  std::function<std::string(std::size_t)> place;
};

/// Even instants, and which of them the rows are.
struct EvenClock {
  TimeBase time;                    ///< frames may be more than rows
  std::vector<std::int64_t> frame;  ///< of each row, increasing; empty: row i is frame i
};

/// The even clock that describes a written time column best.
///
/// Times increase from row to row: a column that stands still or goes back is refused, except where its
/// rounding explains it. A stated rate is taken when the column agrees with it to half of the rounding of the
/// written times, or to 2 % of a frame. Otherwise an even column determines the rate, with a warning. Where
/// rows are a whole multiple of the frame interval apart (to a quarter of one), frames are missing between
/// them: they are counted, with a warning; any other distance of 1.5 intervals and more is refused. What is
/// uneven by less gets the rate of its median step (or the stated one, when they agree) and a warning that
/// gives the largest deviation. Frame 0 is at time_s[0].
///
/// Code::bad_input, with the place, for what is refused, for more than most_frames, and when neither the
/// column nor the header gives a rate. O(rows).
[[nodiscard]] Result<EvenClock> even_clock(const TimeColumn& column, std::vector<std::string>& warnings);

/// Adds a warning where a column that is even otherwise jumps: nine steps in ten, or all but one, within 20 %
/// of their median, one of 1.5 medians or more. For tables, which need no even clock.
void note_jump(const TimeColumn& column, std::vector<std::string>& warnings);

}  // namespace kinemark::io::internal
