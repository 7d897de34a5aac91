// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::data {
namespace {

Table small() {
  Table t;
  t.columns = {"a", "b"};
  t.time_s.assign({0.0, 0.1});
  t.values.assign({1.0, 2.0, 3.0, 4.0});
  return t;
}

TEST(Table, FindsAndReads) {
  const Table t = small();
  EXPECT_TRUE(t.validate());
  EXPECT_EQ(t.find("b"), 1);
  EXPECT_EQ(t.find("time"), -1);
  EXPECT_EQ(t(1, 0), 3.0);
}

TEST(Table, ValidateNamesWhatIsWrong) {
  Table t = small();
  t.values.pop_back();
  EXPECT_THAT(t.validate().error().message, testing::HasSubstr("holds 3 values"));
  t = small();
  t.columns[1] = "a";
  EXPECT_THAT(t.validate().error().message, testing::HasSubstr("'a' occurs twice"));
  t = small();
  t.time_s[1] = 0.0;
  EXPECT_THAT(t.validate().error().message, testing::HasSubstr("row 2"));
}

}  // namespace
}  // namespace kinemark::data
