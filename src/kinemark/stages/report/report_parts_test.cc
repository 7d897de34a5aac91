// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/report_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::report {
namespace {

using testing::HasSubstr;

TEST(ReportOptions, DefaultsHoldAndBoundsAreSaid) {
  EXPECT_TRUE(ReportOptions{}.check());
  EXPECT_TRUE((ReportOptions{.max_points = 2, .max_data_bytes = 2000}.check()));
  const Status few = ReportOptions{.max_points = 1}.check();
  ASSERT_FALSE(few);
  EXPECT_EQ(few.error().code, Code::usage);
  EXPECT_THAT(few.error().message, HasSubstr("max_points is 1; need 2 or more"));
  const Status small = ReportOptions{.max_data_bytes = -5}.check();
  ASSERT_FALSE(small);
  EXPECT_THAT(small.error().message, HasSubstr("max_data_bytes is -5"));
}

TEST(Verdict, IsOneWord) {
  EXPECT_EQ(to_string(Verdict::good), "good");
  EXPECT_EQ(to_string(Verdict::attention), "attention");
}

}  // namespace
}  // namespace kinemark::report
