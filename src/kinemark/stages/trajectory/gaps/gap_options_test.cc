// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/gap_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace kinemark::trajectory {
namespace {

using ::testing::HasSubstr;

TEST(GapMethodNames, ReadBackAndTheFailureListsThem) {
  for (int k = 0; k <= static_cast<int>(GapMethod::automatic); ++k) {
    const auto method = static_cast<GapMethod>(k);
    EXPECT_EQ(parse_gap_method(to_string(method)), method);
  }
  EXPECT_EQ(to_string(GapMethod::automatic), "auto");
  const auto wrong = parse_gap_method("magic");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, Code::usage);
  EXPECT_THAT(wrong.error().message, HasSubstr("'magic'"));
  EXPECT_THAT(wrong.error().message, HasSubstr("regression, pca and auto"));
}

TEST(GapOptionsCheck, RefusesWhatMakesNoSense) {
  EXPECT_TRUE(GapOptions{}.check());
  EXPECT_TRUE(GapOptions{.max_sd_m = std::numeric_limits<double>::infinity()}.check());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const GapOptions& bad :
       {GapOptions{.max_gap_s = 0.0}, GapOptions{.max_gap_s = nan}, GapOptions{.max_sd_m = -1.0},
        GapOptions{.max_sd_m = nan}, GapOptions{.max_extrapolation_s = -0.1}, GapOptions{.noise_sd_m = -1.0},
        GapOptions{.noise_sd_m = std::numeric_limits<double>::infinity()}, GapOptions{.threads = -1}}) {
    const Status s = bad.check();
    ASSERT_FALSE(s);
    EXPECT_EQ(s.error().code, Code::usage);
    EXPECT_THAT(s.error().message, HasSubstr("need"));
  }
}

}  // namespace
}  // namespace kinemark::trajectory
