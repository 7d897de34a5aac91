// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

#include "kinemark/stream/device.h"

namespace kinemark::stream {

/// A block on its way from the thread that reads a device, with the frames that are missing before it.
struct RingBlock {
  Block block;
  std::int64_t lost_by_device = 0;  ///< the device gave none of these
  std::int64_t lost_here = 0;       ///< read, and given up since somebody was too slow
};

/// Blocks between two threads, bounded by their frames. Their memory is used again.
class BlockRing {
 public:
  /// @param most_frames  that wait at once, > 0; one block is always let in, however long
  explicit BlockRing(std::int64_t most_frames) : most_frames_(most_frames) {}
  /// A copy for the other side. false: there is no room, nothing was taken.
  [[nodiscard]] bool try_push(const RingBlock& block);
  /// Wait for room first. false: it was closed meanwhile.
  [[nodiscard]] bool push(const RingBlock& block);
  /// Wait for the next block. false: it was closed, and all blocks before have been taken.
  [[nodiscard]] bool pop(RingBlock& block);
  /// Nothing more comes; both sides wake up.
  void close();
  /// frames that waited at once, at most
  [[nodiscard]] std::int64_t fullest() const;
  [[nodiscard]] std::int64_t most_frames() const { return most_frames_; }  ///< as made

 private:
  [[nodiscard]] bool has_room(const RingBlock& block) const;
  void put(const RingBlock& block);

  const std::int64_t most_frames_;
  mutable std::mutex mutex_;
  std::condition_variable came_, left_;
  std::deque<RingBlock> waiting_;
  std::vector<RingBlock> spare_;
  std::int64_t frames_ = 0, fullest_ = 0;
  bool closed_ = false;
};

}  // namespace kinemark::stream
