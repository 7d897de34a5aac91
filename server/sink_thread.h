// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "kinemark/core/result.h"
#include "kinemark/stream/stream.h"

namespace kinemark::server {

/// Frames on their way from one thread to another, in order.
class FrameQueue {
 public:
  using FramePtr = std::shared_ptr<const stream::Frame>;
  /// @param most  that wait; beyond, the oldest is dropped and counted. 0: none is ever dropped
  explicit FrameQueue(std::size_t most) : most_(most) {}
  void push(FramePtr frame);                   ///< never waits
  void finish();                               ///< no more come
  [[nodiscard]] FramePtr pop();                ///< waits; nullptr: that was all
  [[nodiscard]] std::int64_t dropped() const;  ///< how many

 private:
  std::size_t most_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<FramePtr> waiting_;
  std::int64_t dropped_ = 0;
  bool finished_ = false;
};

/// A sink that takes its frames on a thread of its own, so that it holds nobody back. A failure is said once,
/// and frames that come after it are passed over.
class SinkThread {
 public:
  /// @param most  as of FrameQueue  @param failed  gets the error, on that thread
  SinkThread(std::unique_ptr<stream::Sink> sink, std::size_t most, std::function<void(const Error&)> failed);
  ~SinkThread();                          ///< what was pushed is taken before it returns
  void push(FrameQueue::FramePtr frame);  ///< never waits; not after finish()
  void finish();                          ///< no more frames come; what waits is taken still
  void join();                            ///< waits until all is taken, after finish()
  [[nodiscard]] std::int64_t dropped() const { return queue_.dropped(); }  ///< frames that it did not get

 private:
  void run();
  std::unique_ptr<stream::Sink> sink_;
  FrameQueue queue_;
  std::function<void(const Error&)> failed_;
  std::thread thread_;
};

}  // namespace kinemark::server
