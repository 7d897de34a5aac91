// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/worker.h"

#include <utility>

namespace kinemark::server {

Worker::Worker(std::size_t most, Repeated again)
    : most_(most), again_(std::move(again)), thread_([this] { run(); }) {}

Worker::~Worker() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
    waiting_.clear();
  }
  changed_.notify_one();
  thread_.join();
}

bool Worker::post(std::function<void()> work) {
  {
    const std::scoped_lock lock(mutex_);
    if (ends_ || waiting_.size() >= most_) return false;
    waiting_.push_back(std::move(work));
  }
  changed_.notify_one();
  return true;
}

void Worker::wait(std::unique_lock<std::mutex>& lock, Clock::time_point due) {
  const auto ready = [this] { return ends_ || !waiting_.empty(); };
  if (again_.work)
    changed_.wait_until(lock, due, ready);
  else
    changed_.wait(lock, ready);
}

void Worker::run() {
  auto due = Clock::now() + again_.every;
  std::unique_lock lock(mutex_);
  while (true) {
    wait(lock, due);
    if (ends_) return;
    // What comes again is not kept from its turn by many who ask.
    const bool again = again_.work && (waiting_.empty() || Clock::now() >= due);
    auto work = again ? again_.work : std::move(waiting_.front());
    if (!again) waiting_.pop_front();
    lock.unlock();
    work();
    work = nullptr;
    if (again) due = Clock::now() + again_.every;
    lock.lock();
  }
}

}  // namespace kinemark::server
