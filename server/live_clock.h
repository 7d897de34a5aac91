// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace kinemark::server {

/// The time by which frames come. Tests have one of their own.
class LiveClock {
 public:
  virtual ~LiveClock() = default;
  /// s since some instant; never runs back.
  [[nodiscard]] virtual double now_s() = 0;
  /// Return at that time, or at once where it is over; false: stop() came before.
  [[nodiscard]] virtual bool sleep_until(double time_s) = 0;
  /// From now on nobody sleeps. From any thread.
  virtual void stop() = 0;
};

/// The machine's steady clock.
class SteadyClock final : public LiveClock {
 public:
  [[nodiscard]] double now_s() override {
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  }
  [[nodiscard]] bool sleep_until(double time_s) override {
    const Clock::time_point when(
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s)));
    std::unique_lock lock(mutex_);
    return !changed_.wait_until(lock, when, [this] { return stopped_; });
  }
  void stop() override {
    {
      const std::scoped_lock lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopped_ = false;
};

}  // namespace kinemark::server
