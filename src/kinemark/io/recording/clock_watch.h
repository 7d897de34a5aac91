// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace kinemark::io {

/// Compares the time between messages with the time that their sequence numbers and the nominal rate predict.
/// A clock that jumps or runs backwards is reported; lost messages are not, because number and clock advance
/// together.
class ClockWatch {
 public:
  /// @param rate_hz  messages per second; 0 when unknown, then only running backwards is noticed.
  explicit ClockWatch(double rate_hz) : rate_hz_(rate_hz > 0.0 ? rate_hz : 0.0) {}

  /// Jump of the clock since the last message, s, where it exceeds half a period.
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
