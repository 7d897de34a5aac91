// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/smooth_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::trajectory {
namespace {

using ::testing::HasSubstr;

TEST(SmoothOptions, DefaultsHoldAtAnyRate) {
  for (const double rate : {1.0, 60.0, 10000.0}) EXPECT_TRUE(SmoothOptions{}.check(rate));
}

TEST(SmoothOptions, NamesGoBothWays) {
  for (const auto method : {FilterMethod::none, FilterMethod::kalman, FilterMethod::butterworth,
                            FilterMethod::gcv, FilterMethod::savgol, FilterMethod::classic})
    EXPECT_EQ(parse_filter_method(to_string(method)).value(), method);
  EXPECT_EQ(parse_filter_method("auto").value(), FilterMethod::kalman);
  for (const auto rule : {CutoffRule::winter, CutoffRule::challis})
    EXPECT_EQ(parse_cutoff_rule(to_string(rule)).value(), rule);
}

TEST(SmoothOptions, UnknownNamesListTheKnownOnes) {
  const auto method = parse_filter_method("bessel");
  ASSERT_FALSE(method);
  EXPECT_EQ(method.error().code, Code::usage);
  EXPECT_THAT(method.error().message, HasSubstr("savgol"));
  EXPECT_THAT(parse_cutoff_rule("guess").error().message, HasSubstr("challis"));
}

TEST(SmoothOptions, CutoffStaysBelowHalfTheRate) {
  SmoothOptions options;
  for (const double cutoff : {50.0, 60.0, -1.0, std::nan(""), HUGE_VAL, 1e-9}) {
    options.cutoff_hz = cutoff;
    const auto status = options.check(100.0);
    ASSERT_FALSE(status) << cutoff;
    EXPECT_EQ(status.error().code, Code::usage);
    EXPECT_THAT(status.error().message, HasSubstr("cutoff_hz"));
  }
  options.cutoff_hz = 49.9;
  EXPECT_TRUE(options.check(100.0));
}

TEST(SmoothOptions, EveryMethodHasItsOwnOrders) {
  const auto allowed = [](FilterMethod method, int order) {
    SmoothOptions options;
    options.method = method;
    options.order = order;
    return options.check(100.0).has_value();
  };
  EXPECT_TRUE(allowed(FilterMethod::kalman, 5));
  EXPECT_FALSE(allowed(FilterMethod::kalman, 6));
  EXPECT_FALSE(allowed(FilterMethod::kalman, 1));
  EXPECT_TRUE(allowed(FilterMethod::butterworth, 4));
  EXPECT_FALSE(allowed(FilterMethod::butterworth, 3));
  EXPECT_TRUE(allowed(FilterMethod::savgol, 7));
  EXPECT_FALSE(allowed(FilterMethod::savgol, -1));
  EXPECT_FALSE(allowed(FilterMethod::classic, 4));
  EXPECT_FALSE(allowed(FilterMethod::none, 2));
}

TEST(SmoothOptions, OtherRanges) {
  SmoothOptions noise;
  noise.noise_sd_m = -0.001;
  EXPECT_THAT(noise.check(100.0).error().message, HasSubstr("noise_sd_m is -0.001"));
  SmoothOptions bridge;
  bridge.max_bridge_s = std::nan("");
  EXPECT_FALSE(bridge.check(100.0));
  SmoothOptions threads;
  threads.threads = -2;
  EXPECT_FALSE(threads.check(100.0));
}

}  // namespace
}  // namespace kinemark::trajectory
