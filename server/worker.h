// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace kinemark::server {

/// Work that comes again by itself, for as long as the worker lives.
struct Repeated {
  std::chrono::milliseconds every{100};  ///< from the end of one to the next, or later where others are done
  std::function<void()> work = nullptr;  ///< must not throw; nullptr: none
};

/// A thread that does one piece of work after the other, first come, first served.
class Worker {
 public:
  /// @param most  pieces that may wait
  explicit Worker(std::size_t most, Repeated again = {});
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  /// Ends what is being done; what waits is dropped.
  ~Worker();

  /// Do this when its turn comes; false when too much waits already. Work must not throw.
  [[nodiscard]] bool post(std::function<void()> work);

 private:
  using Clock = std::chrono::steady_clock;
  void run();
  /// Until there is something to do.
  void wait(std::unique_lock<std::mutex>& lock, Clock::time_point due);

  std::size_t most_;
  Repeated again_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool ends_ = false;
  std::thread thread_;  ///< begins last
};

}  // namespace kinemark::server
