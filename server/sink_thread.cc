// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/sink_thread.h"

#include <utility>

namespace kinemark::server {

void FrameQueue::push(FramePtr frame) {
  {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(std::move(frame));
    if (most_ > 0 && waiting_.size() > most_) {
      waiting_.pop_front();
      ++dropped_;
    }
  }
  changed_.notify_one();
}

void FrameQueue::finish() {
  {
    const std::scoped_lock lock(mutex_);
    finished_ = true;
  }
  changed_.notify_all();
}

FrameQueue::FramePtr FrameQueue::pop() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return finished_ || !waiting_.empty(); });
  if (waiting_.empty()) return nullptr;
  auto frame = std::move(waiting_.front());
  waiting_.pop_front();
  return frame;
}

std::int64_t FrameQueue::dropped() const {
  const std::scoped_lock lock(mutex_);
  return dropped_;
}

SinkThread::SinkThread(std::unique_ptr<stream::Sink> sink, std::size_t most,
                       std::function<void(const Error&)> failed)
    : sink_(std::move(sink)), queue_(most), failed_(std::move(failed)), thread_([this] { run(); }) {}

SinkThread::~SinkThread() {
  finish();
  join();
}

void SinkThread::push(FrameQueue::FramePtr frame) { queue_.push(std::move(frame)); }

void SinkThread::finish() { queue_.finish(); }

void SinkThread::join() {
  if (thread_.joinable()) thread_.join();
}

void SinkThread::run() {
  Status status;
  while (const auto frame = queue_.pop()) {
    if (!status) continue;
    status = sink_->push(*frame);
    if (!status) failed_(status.error());
  }
  if (!status) return;
  if (auto s = sink_->finish(); !s) failed_(s.error());
}

}  // namespace kinemark::server
