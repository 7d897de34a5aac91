// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/groups/arrangements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace kinemark::analysis {
namespace {

using Labels = Arrangements::Labels;

std::multiset<Labels> all(Arrangements& arrangements) {
  std::multiset<Labels> found;
  for (std::int64_t i = 0; i < arrangements.count(); ++i) found.insert(arrangements.next());
  return found;
}

TEST(Arrangements, EveryOneOfFewOnce) {
  auto groups = Arrangements::of_groups({2, 1, 2}, 1000, 1);
  EXPECT_TRUE(groups.exact());
  EXPECT_EQ(groups.possible(), 30.0);  // 5! / (2! 1! 2!)
  const auto found = all(groups);
  EXPECT_EQ(found.size(), 30u);
  EXPECT_EQ(std::set<Labels>(found.begin(), found.end()).size(), 30u);

  auto signs = Arrangements::of_signs(4, 1000, 1);
  EXPECT_EQ(signs.count(), 16);
  const auto turned = all(signs);
  EXPECT_EQ(std::set<Labels>(turned.begin(), turned.end()).size(), 16u);
}

TEST(Arrangements, TheObservedOneComesFirst) {
  auto few = Arrangements::of_groups({2, 2}, 1000, 1);
  EXPECT_EQ(few.next(), (Labels{0, 0, 1, 1}));
  auto many = Arrangements::of_groups({20, 20}, 50, 1);
  EXPECT_FALSE(many.exact());
  EXPECT_EQ(many.count(), 50);
  EXPECT_DOUBLE_EQ(many.possible(), 137846528820.0);
  const Labels first = many.next();
  EXPECT_EQ(first.front(), 0);
  EXPECT_TRUE(std::is_sorted(first.begin(), first.end()));
}

TEST(Arrangements, RandomOnesKeepSizesAndAreEquallyLikely) {
  auto groups = Arrangements::of_groups({2, 2}, 5, 7);  // 6 possible, so drawn
  EXPECT_FALSE(groups.exact());
  std::map<Labels, int> times;
  auto many = Arrangements::of_groups({10, 10}, 6001, 7);
  (void)many.next();
  std::vector<int> in_first(20, 0);
  for (int i = 0; i < 6000; ++i) {
    const Labels& labels = many.next();
    EXPECT_EQ(std::ranges::count(labels, 0), 10);
    for (std::size_t k = 0; k < labels.size(); ++k) in_first[k] += labels[k] == 0;
  }
  for (const int n : in_first) EXPECT_NEAR(n, 3000, 5.0 * 38.7);  // 5 SD of a binomial

  auto signs = Arrangements::of_signs(60, 4001, 7);
  EXPECT_FALSE(signs.exact());
  (void)signs.next();
  int turned = 0;
  for (int i = 0; i < 4000; ++i) turned += signs.next()[59];
  EXPECT_NEAR(turned, 2000, 5.0 * 31.6);
}

TEST(Arrangements, TheSameAgainFromTheFirst) {
  auto groups = Arrangements::of_groups({8, 8}, 20, 3);
  const auto once = all(groups);
  EXPECT_EQ(once, all(groups));
  auto other = Arrangements::of_groups({8, 8}, 20, 4);
  EXPECT_NE(once, all(other));
}

TEST(Arrangements, OfVeryManyCurvesAreNotCounted) {
  const auto signs = Arrangements::of_signs(5000, 10, 1);
  EXPECT_TRUE(std::isinf(signs.possible()));
  EXPECT_EQ(signs.count(), 10);
  EXPECT_EQ(Arrangements::of_groups({900, 900, 900}, 10, 1).count(), 10);
}

}  // namespace
}  // namespace kinemark::analysis
