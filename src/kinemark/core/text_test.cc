// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/text.h"

#include <gtest/gtest.h>

#include <vector>

namespace kinemark {
namespace {

using Names = std::vector<std::string>;

TEST(Text, JoinsNames) {
  EXPECT_EQ(join(Names{}), "");
  EXPECT_EQ(join(Names{"A"}), "A");
  EXPECT_EQ(join(Names{"A", "", "C"}), "A, , C");
  EXPECT_EQ(join(Names{"A", "B"}, " or "), "A or B");
}

TEST(Text, CountsTheNamesThatItLeavesOut) {
  EXPECT_EQ(join_some(Names{}, 2), "");
  EXPECT_EQ(join_some(Names{"A", "B"}, 2), "A, B");
  EXPECT_EQ(join_some(Names{"A", "B", "C"}, 2), "A, B and 1 more");
}

TEST(Text, PutsAndBeforeTheLastName) {
  EXPECT_EQ(join_names(Names{}, 3), "");
  EXPECT_EQ(join_names(Names{"A"}, 3), "A");
  EXPECT_EQ(join_names(Names{"A", "B"}, 3), "A and B");
  EXPECT_EQ(join_names(Names{"A", "B", "C"}, 3), "A, B and C");
  EXPECT_EQ(join_names(Names{"A", "B", "C", "D", "E"}, 3), "A, B, C and 2 more");
}

}  // namespace
}  // namespace kinemark
