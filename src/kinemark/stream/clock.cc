// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/clock.h"

#include <chrono>
#include <thread>

namespace kinemark::stream {

using Clock = std::chrono::steady_clock;
using std::chrono::duration_cast;
using std::chrono::nanoseconds;

std::int64_t SteadyHostClock::now_ns() const {
  return duration_cast<nanoseconds>(Clock::now().time_since_epoch()).count();
}

void SteadyHostClock::sleep_until(std::int64_t time_ns) {
  std::this_thread::sleep_until(Clock::time_point(duration_cast<Clock::duration>(nanoseconds(time_ns))));
}

}  // namespace kinemark::stream
