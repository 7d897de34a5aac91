// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/each_seed.h"

#include <gmock/gmock.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace kinemark::studies {
namespace {

using ::testing::ElementsAre;

TEST(RunEach, DoesEveryPieceOnceOnAnyNumberOfThreads) {
  for (const int threads : {1, 2, 7}) {
    std::vector<std::atomic<int>> times(23);
    ASSERT_TRUE(run_each(23, threads, {}, [&](std::size_t i) { ++times[i]; }));
    for (std::size_t i = 0; i < times.size(); ++i) EXPECT_EQ(times[i], 1) << i << " on " << threads;
  }
  EXPECT_TRUE(run_each(0, 2, {}, [](std::size_t) { FAIL() << "there is nothing to do"; }));
}

TEST(RunEach, TellsHowMuchIsDoneBeforeEachPiece) {
  std::vector<std::int64_t> predicted;
  const Progress listen = [&](std::int64_t done, std::int64_t total) {
    EXPECT_EQ(total, 4);
    predicted.push_back(done);
    return true;
  };
  ASSERT_TRUE(run_each(4, 1, listen, [](std::size_t) {}));
  EXPECT_THAT(predicted, ElementsAre(0, 1, 2, 3));
}

TEST(RunEach, PassesOnWhatTheWorkThrows) {
  for (const int threads : {1, 2})
    EXPECT_THROW((void)run_each(5, threads, {}, [](std::size_t) { throw std::runtime_error("no rig"); }),
                 std::runtime_error);
}

TEST(RunEach, EndsAtTheFirstNo) {
  std::vector<std::size_t> done;
  const auto status = run_each(
      9, 1, [](std::int64_t d, std::int64_t) { return d < 2; }, [&](std::size_t i) { done.push_back(i); });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Code::cancelled);
  EXPECT_EQ(status.error().message, "the study was stopped");
  EXPECT_THAT(done, ElementsAre(0, 1));
}

}  // namespace
}  // namespace kinemark::studies
