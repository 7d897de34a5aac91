// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/distinct_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace kinemark {
namespace {

using testing::ElementsAre;

TEST(DistinctNames, NamesThatDifferStay) {
  std::vector<std::string> names{"A", "a", "A_2"};
  const auto repeated = make_distinct(names);
  EXPECT_EQ(repeated.changed, 0U);
  EXPECT_EQ(repeated.example, "");
  EXPECT_THAT(names, ElementsAre("A", "a", "A_2"));
  EXPECT_EQ(make_distinct({}).changed, 0U);
}

TEST(DistinctNames, TheFirstKeepsItsNameAndOthersGetNumbers) {
  std::vector<std::string> names{"B", "A", "A", "A", "B"};
  const auto repeated = make_distinct(names);
  EXPECT_EQ(repeated.changed, 3U);
  EXPECT_EQ(repeated.example, "A");
  EXPECT_THAT(names, ElementsAre("B", "A", "A_2", "A_3", "B_2"));
}

TEST(DistinctNames, ANameThatStandsLaterIsNotTaken) {
  std::vector<std::string> names{"A", "A", "A_2", "A_2"};
  EXPECT_EQ(make_distinct(names).changed, 2U);
  EXPECT_THAT(names, ElementsAre("A", "A_3", "A_2", "A_2_2"));
}

TEST(DistinctNames, ManyEqualOnesAreAllDifferentAfterwards) {
  std::vector<std::string> names(20'000, "M");
  EXPECT_EQ(make_distinct(names).changed, names.size() - 1);
  EXPECT_EQ(std::set(names.begin(), names.end()).size(), names.size());
  EXPECT_EQ(names.back(), "M_20000");
}

}  // namespace
}  // namespace kinemark
