// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/rate.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace kinemark::io {
namespace {

TEST(Rate, KnowsWhatNoClockRunsAt) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double none : {0.0, -100.0, std::nan(""), kInfinity, -kInfinity, 1e-9, 1e30}) {
    const auto status = check_rate(none, "DataRate");
    ASSERT_FALSE(status) << none;
    EXPECT_EQ(status.error().code, Code::bad_input);
    EXPECT_THAT(status.error().message, ::testing::HasSubstr("expected a frame rate of 0.001 to 1000000 Hz"));
  }
  for (const double good : {0.001, 1.0, 59.94006, 240.0, 20'000.0, 1e6})
    EXPECT_TRUE(check_rate(good, "x")) << good;
}

TEST(Rate, ZeroIsNotKnownAndSaid) {
  std::vector<std::string> warnings;
  EXPECT_FALSE(states_rate(0.0, "DataRate", warnings).value());
  EXPECT_FALSE(states_rate(-0.0, "POINT:RATE", warnings).value());
  EXPECT_THAT(warnings, ::testing::ElementsAre("DataRate is 0, which is taken as not known",
                                               "POINT:RATE is 0, which is taken as not known"));
  EXPECT_TRUE(states_rate(100.0, "DataRate", warnings).value());
  EXPECT_EQ(states_rate(-100.0, "DataRate", warnings).error().code, Code::bad_input);
  EXPECT_FALSE(states_rate(std::nan(""), "DataRate", warnings));
  EXPECT_EQ(warnings.size(), 2U);
}

}  // namespace
}  // namespace kinemark::io
