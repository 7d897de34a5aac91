// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"

namespace kinemark::math {
namespace {

TEST(Statistics, MedianOfEvenNumbersIsTheMeanOfTheTwoInTheMiddle) {
  EXPECT_EQ(median(std::vector{3.0}), 3.0);
  EXPECT_EQ(median(std::vector{5.0, 1.0, 3.0}), 3.0);
  EXPECT_EQ(median(std::vector{7.0, 1.0, 5.0, 3.0}), 4.0);
  EXPECT_EQ(upper_median(std::vector{7.0, 1.0, 5.0, 3.0}), 5.0);
  EXPECT_EQ(upper_median(std::vector{5.0, 1.0, 3.0}), 3.0);
}

TEST(Statistics, QuantileIsTheValueAtTheNearestRank) {
  const std::vector values{40.0, 10.0, 30.0, 20.0, 50.0, 60.0};
  EXPECT_EQ(quantile(values, 0.0), 10.0);
  EXPECT_EQ(quantile(values, 1.0), 60.0);
  EXPECT_EQ(quantile(values, 0.2), 20.0);
  EXPECT_EQ(quantile(values, 0.29), 20.0);  // rank 1.45
  EXPECT_EQ(quantile(values, 0.31), 30.0);  // rank 1.55
  EXPECT_EQ(quantile(values, 0.5), 40.0);   // rank 2.5: up
}

TEST(Statistics, AllRanksAreThoseOfTheSortedValues) {
  Random random(11, 1);
  for (std::size_t n = 1; n < 40; ++n) {
    std::vector<double> values(n);
    for (double& v : values) v = std::round(random.uniform(-9.0, 9.0));  // ties
    const auto before = values;
    auto sorted = values;
    std::ranges::sort(sorted);
    for (std::size_t rank = 0; rank < n; ++rank) EXPECT_EQ(nth_smallest(values, rank), sorted[rank]);
    EXPECT_EQ(median(values), 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]));
    EXPECT_EQ(values, before);
  }
}

TEST(Statistics, MedianOfManyIsThatOfTheSortedValues) {
  Random random(12, 1);
  for (const std::size_t n : {4096, 5001, 20000}) {
    std::vector<double> values(n);
    for (double& v : values) v = random.gaussian();
    for (int kind = 0; kind < 4; ++kind) {
      // As they come, in order (which a sample of them is too), few different ones, and bounds that all lie
      // on one side.
      if (kind == 1) std::ranges::sort(values);
      if (kind == 2)
        for (double& v : values) v = std::round(v);
      if (kind == 3)
        for (std::size_t i = 0; i < n; ++i)
          values[i] = i % (n / 512) == 0 ? 1e3 + static_cast<double>(i) : random.uniform();
      auto sorted = values;
      std::ranges::sort(sorted);
      EXPECT_EQ(median(values), 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2])) << n << " " << kind;
    }
  }
}

TEST(Statistics, NothingAndMissingValuesHaveNone) {
  for (const std::vector<double>& values : {std::vector<double>{}, std::vector{1.0, kNaN, 2.0}}) {
    EXPECT_TRUE(std::isnan(median(values)));
    EXPECT_TRUE(std::isnan(upper_median(values)));
    EXPECT_TRUE(std::isnan(quantile(values, 0.5)));
  }
}

TEST(Statistics, RefusesRanksThatAreNotThere) {
  const std::vector values{1.0, 2.0};
  EXPECT_ANY_THROW((void)nth_smallest(values, 2));
  EXPECT_ANY_THROW((void)quantile(values, 1.1));
}

}  // namespace
}  // namespace kinemark::math
