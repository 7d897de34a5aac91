// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/block_ring.h"

#include <algorithm>
#include <utility>

namespace kinemark::stream {

bool BlockRing::has_room(const RingBlock& block) const {
  return waiting_.empty() || frames_ + block.block.frames <= most_frames_;
}

void BlockRing::put(const RingBlock& block) {
  RingBlock copy;
  if (!spare_.empty()) {
    copy = std::move(spare_.back());
    spare_.pop_back();
  }
  copy = block;
  waiting_.push_back(std::move(copy));
  frames_ += block.block.frames;
  fullest_ = std::max(fullest_, frames_);
  came_.notify_one();
}

bool BlockRing::try_push(const RingBlock& block) {
  const std::scoped_lock lock(mutex_);
  if (closed_ || !has_room(block)) return false;
  put(block);
  return true;
}

bool BlockRing::push(const RingBlock& block) {
  std::unique_lock lock(mutex_);
  left_.wait(lock, [&] { return closed_ || has_room(block); });
  if (closed_) return false;
  put(block);
  return true;
}

bool BlockRing::pop(RingBlock& block) {
  std::unique_lock lock(mutex_);
  came_.wait(lock, [&] { return closed_ || !waiting_.empty(); });
  if (waiting_.empty()) return false;
  std::swap(block, waiting_.front());
  spare_.push_back(std::move(waiting_.front()));
  waiting_.pop_front();
  frames_ -= block.block.frames;
  left_.notify_one();
  return true;
}

void BlockRing::close() {
  const std::scoped_lock lock(mutex_);
  closed_ = true;
  came_.notify_all();
  left_.notify_all();
}

std::int64_t BlockRing::fullest() const {
  const std::scoped_lock lock(mutex_);
  return fullest_;
}

}  // namespace kinemark::stream
