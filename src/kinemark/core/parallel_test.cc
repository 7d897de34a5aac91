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

TEST(ParallelFor, RefusesANonsenseGrain) {
  EXPECT_THROW(parallel_for(10, 0, 1, [](std::int64_t, std::int64_t) {}), ContractError);
}

}  // namespace
}  // namespace kinemark
