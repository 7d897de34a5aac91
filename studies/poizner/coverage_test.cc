// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinemark/core/random.h"

namespace kinemark::studies {
namespace {

TEST(Coverage, CountsBothSidesAndWhatLiesOnTheEdge) {
  Coverage coverage;
  for (const double error : {0.0, 1.0, -1.0, 1.5, -2.0, 2.1, -7.0}) coverage.add(error, 1.0);
  EXPECT_EQ(coverage.all, 7);
  EXPECT_EQ(coverage.within_1, 3);
  EXPECT_EQ(coverage.within_2, 5);
}

TEST(Coverage, WhatIsNoNumberIsNotCovered) {
  Coverage coverage;
  const double none = std::numeric_limits<double>::quiet_NaN();
  coverage.add(none, 1.0);
  coverage.add(0.0, none);
  EXPECT_EQ(coverage.all, 2);
  EXPECT_EQ(coverage.within_2, 0);
  EXPECT_TRUE(std::isnan(Coverage{}.share_1()));
}

TEST(Coverage, NormalErrorsLieWhereTheyShould) {
  Random random(3, 0);
  Coverage one, two;
  for (int i = 0; i < 20000; ++i) {
    const double error = 0.7 * random.gaussian();
    (i % 2 == 0 ? one : two).add(error, 0.7);
  }
  one += two;
  EXPECT_EQ(one.all, 20000);
  EXPECT_NEAR(one.share_1(), 0.6827, 0.012);
  EXPECT_NEAR(one.share_2(), 0.9545, 0.006);
}

}  // namespace
}  // namespace kinemark::studies
