// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/block_ring.h"

#include <gmock/gmock.h>

#include <thread>

namespace kinemark::stream {
namespace {

RingBlock block_of(std::int64_t first, std::int64_t frames) {
  return {.block = {.first_frame = first,
                    .frames = frames,
                    .counts = std::vector<std::int16_t>(static_cast<std::size_t>(frames), 7)}};
}

TEST(BlockRing, GivesBlocksInTheirOrderAndRefusesWhatDoesNotFit) {
  BlockRing ring(10);
  EXPECT_TRUE(ring.try_push(block_of(0, 6)));
  EXPECT_TRUE(ring.try_push(block_of(6, 4)));
  EXPECT_FALSE(ring.try_push(block_of(10, 1)));
  EXPECT_EQ(ring.fullest(), 10);
  RingBlock out;
  ASSERT_TRUE(ring.pop(out));
  EXPECT_EQ(out.block.first_frame, 0);
  EXPECT_EQ(out.block.counts.size(), 6U);
  EXPECT_TRUE(ring.try_push(block_of(10, 6)));
  ASSERT_TRUE(ring.pop(out));
  EXPECT_EQ(out.block.first_frame, 6);
}

TEST(BlockRing, LetsOneBlockInHoweverLong) {
  BlockRing ring(10);
  EXPECT_TRUE(ring.try_push(block_of(0, 100)));
  EXPECT_FALSE(ring.try_push(block_of(100, 1)));
}

TEST(BlockRing, ClosedGivesWhatIsLeftThenNothing) {
  BlockRing ring(10);
  ASSERT_TRUE(ring.push(block_of(0, 1)));
  ring.close();
  EXPECT_FALSE(ring.push(block_of(1, 1)));
  EXPECT_FALSE(ring.try_push(block_of(1, 1)));
  RingBlock out;
  EXPECT_TRUE(ring.pop(out));
  EXPECT_FALSE(ring.pop(out));
}

TEST(BlockRing, BetweenTwoThreadsLosesNothingWhereOneWaits) {
  BlockRing ring(16);
  std::jthread writer([&ring] {
    for (std::int64_t f = 0; f < 3000; f += 3) EXPECT_TRUE(ring.push(block_of(f, 3)));
    ring.close();
  });
  RingBlock out;
  std::int64_t next = 0;
  while (ring.pop(out)) {
    EXPECT_EQ(out.block.first_frame, next);
    next += out.block.frames;
  }
  EXPECT_EQ(next, 3000);
  EXPECT_LE(ring.fullest(), 16);
}

TEST(BlockRing, AThreadThatWaitsForRoomWakesWhenItIsClosed) {
  BlockRing ring(1);
  ASSERT_TRUE(ring.push(block_of(0, 1)));
  std::jthread waits([&ring] { EXPECT_FALSE(ring.push(block_of(1, 1))); });
  ring.close();
}

}  // namespace
}  // namespace kinemark::stream
