// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>

namespace kinemark {
namespace {

// Golden values of the written definition, computed with exact integers outside this program.
TEST(Random, MatchesTheWrittenDefinition) {
  Random uniforms(1986, 1);
  for (const double expected :
       {0.017504261585495673, 0.7350003264505316, 0.5328810609485105, 0.6920444069953046})
    EXPECT_EQ(uniforms.uniform(), expected);
  Random gaussians(1986, 1);
  for (const double expected :
       {-0.017685607027194856, -0.43943090311699623, -0.9069449729276617, 0.23898224104227897})
    EXPECT_DOUBLE_EQ(gaussians.gaussian(), expected);
}

TEST(Random, DrawDependsOnItsNumberOnly) {
  Random a(7, 3), b(7, 3);
  for (int i = 0; i < 10; ++i) (void)a.uniform();
  const double eleventh = a.uniform();
  b.seek(10);
  EXPECT_EQ(b.uniform(), eleventh);
  EXPECT_EQ(b.draws(), 11U);
}

TEST(Random, UniformStaysBelowItsUpperEnd) {
  Random random(9, 4);
  double low = 1.0, high = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double u = random.uniform();
    low = std::min(low, u);
    high = std::max(high, u);
  }
  EXPECT_GE(low, 0.0);
  EXPECT_LT(low, 1e-4);
  EXPECT_LT(high, 1.0);
  EXPECT_GT(high, 1.0 - 1e-4);
}

TEST(Random, ADrawSaysNothingOfTheNextOrOfTheNextStream) {
  constexpr int kDraws = 20000;
  double along = 0.0, across = 0.0;
  Random one(3, 10), next(3, 11);
  double before = one.gaussian();
  for (int i = 0; i < kDraws; ++i) {
    const double now = one.gaussian();
    along += before * now / kDraws;
    across += now * next.gaussian() / kDraws;
    before = now;
  }
  EXPECT_NEAR(along, 0.0, 5.0 / std::sqrt(kDraws));
  EXPECT_NEAR(across, 0.0, 5.0 / std::sqrt(kDraws));
}

TEST(Random, MixingIsOneToOneAndChangesHalfOfTheBits) {
  std::set<std::uint64_t> mixed;
  int flipped = 0;
  for (std::uint64_t z = 0; z < 4096; ++z) {
    mixed.insert(mix64(z));
    flipped += std::popcount(mix64(z) ^ mix64(z ^ (std::uint64_t{1} << (z % 64))));
  }
  EXPECT_EQ(mixed.size(), 4096U);
  EXPECT_NEAR(flipped / 4096.0, 32.0, 0.5);
}

TEST(Random, StreamsAndSeedsDiffer) {
  std::set<double> first;
  for (std::uint64_t seed = 0; seed < 50; ++seed)
    for (std::uint64_t stream = 0; stream < 50; ++stream) first.insert(Random(seed, stream).uniform());
  EXPECT_EQ(first.size(), 2500U);
}

TEST(Random, MomentsAreThoseOfTheDistributions) {
  Random random(42, 0);
  const int n = 200000;
  double sum = 0, sum2 = 0, sum4 = 0, uniform_sum = 0;
  for (int i = 0; i < n; ++i) {
    const double g = random.gaussian();
    sum += g;
    sum2 += g * g;
    sum4 += g * g * g * g;
    uniform_sum += random.uniform(-1.0, 3.0);
  }
  EXPECT_NEAR(sum / n, 0.0, 5.0 / std::sqrt(n));
  EXPECT_NEAR(sum2 / n, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(sum4 / n, 3.0, 5.0 * std::sqrt(96.0 / n));
  EXPECT_NEAR(uniform_sum / n, 1.0, 5.0 * 4.0 / std::sqrt(12.0 * n));
}

}  // namespace
}  // namespace kinemark
