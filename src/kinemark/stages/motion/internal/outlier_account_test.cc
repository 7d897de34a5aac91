// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/outlier_account.h"

#include <gtest/gtest.h>

namespace kinemark::motion::internal {
namespace {

TEST(OutlierAccount, AStretchGrowsInEitherDirectionOfTime) {
  OutlierAccount account(3);
  EXPECT_FALSE(account.lasts(1));
  for (const std::int64_t frame : {7, 6, 5}) account.extend(1, frame).distance = 20.0;
  EXPECT_TRUE(account.lasts(1));
  EXPECT_FALSE(account.lasts(0));
  EXPECT_EQ(account.lasting(1).first_frame, 5);
  EXPECT_EQ(account.lasting(1).last_frame, 7);
  account.extend(1, 8);
  EXPECT_EQ(account.lasting(1).last_frame, 8);
  EXPECT_EQ(account.lasting(1).distance, 20.0);
}

TEST(OutlierAccount, HandsOverInTheOrderOfTheirEndsAndThoseThatNeverReturnedLast) {
  OutlierAccount account(4);
  for (const int m : {0, 1, 2}) account.extend(m, 10 + m);
  account.end(2, true);
  account.end(0, true);
  account.extend(0, 30);
  account.add({.marker = 3, .first_frame = 1, .last_frame = 4});
  const auto found = account.finish();
  ASSERT_EQ(found.size(), 5U);
  const int expected[] = {2, 0, 3, 0, 1};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(found[i].marker, expected[i]) << i;
    EXPECT_EQ(found[i].returned, i < 3) << i;
  }
  EXPECT_EQ(found[3].first_frame, 30) << "a span of its own";
  EXPECT_TRUE(account.finish().empty());
}

TEST(OutlierAccount, ForgettingKeepsWhatLasts) {
  OutlierAccount account(2);
  account.extend(0, 3);
  account.extend(1, 4);
  account.end(0, true);
  account.forget();
  EXPECT_FALSE(account.lasts(0));
  EXPECT_EQ(account.extend(1, 5).first_frame, 4);
  account.end(1, true);
  account.forget();
  EXPECT_TRUE(account.finish().empty());
}

TEST(Outlier, IsClearlyWrongOnlyWhenMuchFartherThanExpectedByBothMeasures) {
  const auto wrong = [](double from, double expected) {
    return Outlier{.from_model_m = from, .expected_from_model_m = expected}.clearly_wrong();
  };
  EXPECT_TRUE(wrong(0.05, 0.0));
  EXPECT_FALSE(wrong(0.009, 0.0)) << "a centimetre is little";
  EXPECT_FALSE(wrong(0.13, 0.1)) << "half as much again is little";
  EXPECT_TRUE(wrong(0.16, 0.1));
  EXPECT_FALSE(wrong(0.0, 0.1)) << "it came nearer";
}

}  // namespace
}  // namespace kinemark::motion::internal
