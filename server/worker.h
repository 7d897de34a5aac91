// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace kinemark::server {

/// A thread that does one piece of work after the other, first come, first served.
class Worker {
 public:
  /// @param most  pieces that may wait
  explicit Worker(std::size_t most);
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  /// Ends what is being done; what waits is dropped.
  ~Worker();

  /// Do this when its turn comes; false when too much waits already. Work must not throw.
  [[nodiscard]] bool post(std::function<void()> work);

 private:
  void run();

  std::size_t most_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool ends_ = false;
  std::thread thread_;  ///< begins last
};

}  // namespace kinemark::server
