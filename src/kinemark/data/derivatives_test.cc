// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/derivatives.h"

#include <gmock/gmock.h>

#include <limits>

namespace kinemark::data {
namespace {

using testing::HasSubstr;

const Trajectories& three_frames() {
  static const auto t = Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 3});
  return t;
}

Derivatives good() {
  Derivatives d;
  d.velocity.assign(18, 0.0);
  d.velocity_sd.assign(18, std::numeric_limits<double>::quiet_NaN());
  d.filters.resize(2);
  return d;
}

TEST(Derivatives, NaNAndAbsentArraysAreValid) { EXPECT_TRUE(good().validate(three_frames())); }

TEST(Derivatives, EachBrokenRuleIsNamed) {
  auto d = good();
  d.jerk.assign(17, 0.0);
  EXPECT_THAT(d.validate(three_frames()).error().message, HasSubstr("17 numbers of jerk; need 18"));
  d = good();
  d.velocity_sd[4] = -1e-9;
  EXPECT_THAT(d.validate(three_frames()).error().message, HasSubstr("negative velocity_sd"));
  d = good();
  d.filters.pop_back();
  EXPECT_THAT(d.validate(three_frames()).error().message, HasSubstr("1 filters for 2 markers"));
}

}  // namespace
}  // namespace kinemark::data
