// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace kinemark::io {

/// Compares the time between messages with what their numbers and the nominal rate say: a clock that runs
/// backwards or leaps does not fit. Loss alone does: the number steps with the clock.
class ClockWatch {
 public:
  /// @param rate_hz  messages per second; 0 when unknown, then only running backwards is noticed.
  explicit ClockWatch(double rate_hz) : rate_hz_(rate_hz > 0.0 ? rate_hz : 0.0) {}

  /// How far the clock jumped since the last message, s, when that is more than half a period.
  std::optional<double> observe(std::uint32_t sequence, std::uint64_t log_time_ns);

 private:
  double rate_hz_;
  bool first_ = true;
  std::uint32_t sequence_ = 0;
  std::uint64_t time_ns_ = 0;
};

/// How many numbers `to` comes after `from`, counters of 32 bits that begin again at 0: negative when before.
[[nodiscard]] inline std::int64_t steps_between(std::uint32_t from, std::uint32_t to) {
  return static_cast<std::int32_t>(to - from);
}

}  // namespace kinemark::io
