// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/clock_watch.h"

#include <cmath>

namespace kinemark::io {

std::optional<double> ClockWatch::observe(std::uint32_t sequence, std::uint64_t log_time_ns) {
  const bool first = first_;
  const std::int64_t steps = steps_between(sequence_, sequence);
  const bool back = log_time_ns < time_ns_;
  const auto size_s = 1e-9 * static_cast<double>(back ? time_ns_ - log_time_ns : log_time_ns - time_ns_);
  const double passed_s = back ? -size_s : size_s;
  first_ = false;
  sequence_ = sequence;
  time_ns_ = log_time_ns;
  if (first) return {};
  if (rate_hz_ == 0.0) return back ? std::optional(passed_s) : std::nullopt;
  const double jump_s = passed_s - static_cast<double>(steps) / rate_hz_;
  if (std::abs(jump_s) <= 0.5 / rate_hz_) return {};
  return jump_s;
}

}  // namespace kinemark::io
