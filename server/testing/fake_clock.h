// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>

#include "server/live_clock.h"

namespace kinemark::server::testing {

/// Whoever sleeps wakes at once, and it is that late by then.
class FakeClock final : public LiveClock {
 public:
  [[nodiscard]] double now_s() override { return now_s_; }
  [[nodiscard]] bool sleep_until(double time_s) override {
    if (stopped_) return false;
    now_s_ = std::max(now_s_.load(), time_s);
    return true;
  }
  void stop() override { stopped_ = true; }
  /// Let time pass.
  void pass(double seconds) { now_s_ = now_s_ + seconds; }

 private:
  std::atomic<double> now_s_ = 100.0;
  std::atomic<bool> stopped_ = false;
};

}  // namespace kinemark::server::testing
