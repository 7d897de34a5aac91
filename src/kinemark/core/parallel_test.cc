// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/parallel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "kinemark/core/check.h"

namespace kinemark {
namespace {

std::vector<double> chunked_sums(int threads) {
  std::vector<double> sums(11);
  parallel_for(1003, 100, threads, [&](std::int64_t begin, std::int64_t end) {
    double sum = 0.0;
    for (std::int64_t i = begin; i < end; ++i) sum += std::sin(static_cast<double>(i)) / 3.0;
    sums[static_cast<std::size_t>(begin / 100)] = sum;
  });
  return sums;
}

TEST(ParallelFor, SameBitsForAnyNumberOfThreads) {
  const auto one = chunked_sums(1);
  for (const int threads : {2, 3, 8, 0}) EXPECT_EQ(one, chunked_sums(threads)) << threads;
}

TEST(ParallelFor, VisitsEveryIndexOnce) {
  std::vector<int> seen(517, 0);
  parallel_for(517, 10, 4, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) ++seen[static_cast<std::size_t>(i)];
  });
  EXPECT_EQ(seen, std::vector<int>(517, 1));
}

TEST(ParallelFor, NothingToDoIsFine) {
  parallel_for(0, 5, 2, [](std::int64_t, std::int64_t) { FAIL(); });
}

TEST(ParallelFor, PassesAnExceptionOn) {
  EXPECT_THROW(parallel_for(100, 1, 2,
                            [](std::int64_t begin, std::int64_t) {
                              if (begin == 50) throw std::runtime_error("chunk 50");
                            }),
               std::runtime_error);
}

TEST(ParallelFor, ChunksAreOfTheGrainAndTheLastHasTheRest) {
  for (const int threads : {1, 4}) {
    std::vector<std::int64_t> length(5, 0);
    parallel_for(42, 10, threads, [&](std::int64_t begin, std::int64_t end) {
      length[static_cast<std::size_t>(begin / 10)] = end - begin;
    });
    EXPECT_EQ(length, (std::vector<std::int64_t>{10, 10, 10, 10, 2})) << threads;
  }
  int calls = 0;
  parallel_for(3, 1000, 4, [&](std::int64_t begin, std::int64_t end) {
    EXPECT_EQ(begin, 0);
    EXPECT_EQ(end, 3);
    ++calls;
  });
  EXPECT_EQ(calls, 1) << "a grain beyond the count is one chunk";
}

TEST(ParallelFor, OneThreadGoesInOrderAndStopsAtAnException) {
  std::vector<std::int64_t> seen;
  EXPECT_THROW(parallel_for(10, 1, 1,
                            [&](std::int64_t begin, std::int64_t) {
                              seen.push_back(begin);
                              if (begin == 3) throw std::runtime_error("enough");
                            }),
               std::runtime_error);
  EXPECT_EQ(seen, (std::vector<std::int64_t>{0, 1, 2, 3}));
}

TEST(ParallelFor, MayBeCalledFromWithinItself) {
  std::vector<int> cells(24 * 24, 0);
  parallel_for(24, 1, 3, [&](std::int64_t row, std::int64_t) {
    parallel_for(24, 5, 3, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t column = begin; column < end; ++column)
        ++cells[static_cast<std::size_t>(24 * row + column)];
    });
  });
  EXPECT_EQ(cells, std::vector<int>(24 * 24, 1));
}

TEST(ThreadCount, ZeroIsEveryCoreAndNegativeIsRefused) {
  EXPECT_EQ(thread_count(5), 5);
  EXPECT_GE(thread_count(0), 1);
  EXPECT_THROW((void)thread_count(-1), ContractError);
}

TEST(ParallelFor, RefusesANonsenseGrain) {
  EXPECT_THROW(parallel_for(10, 0, 1, [](std::int64_t, std::int64_t) {}), ContractError);
  EXPECT_THROW(parallel_for(-1, 1, 1, [](std::int64_t, std::int64_t) {}), ContractError);
}

}  // namespace
}  // namespace kinemark
