// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/wrenches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/core/missing.h"

namespace kinemark::data {
namespace {

using ::testing::HasSubstr;

Wrenches one_plate() {
  Wrenches wrenches;
  wrenches.time = {.rate_hz = 100.0, .frames = 2};
  wrenches.items.push_back({.name = "plate 1",
                            .force = {0.0, 0.0, 700.0, 0.0, 0.0, 0.0},
                            .moment = {0.0, 0.0, 1.0, 0.0, 0.0, 0.0},
                            .point = {0.1, 0.2, 0.0, kNaN, kNaN, kNaN}});
  return wrenches;
}

TEST(Wrenches, NeedNoPointWhereNothingActs) { EXPECT_TRUE(one_plate().validate()); }

TEST(Wrenches, MayBeUnknown) {
  auto wrenches = one_plate();
  wrenches.items[0].force[3] = wrenches.items[0].force[4] = wrenches.items[0].force[5] = kNaN;
  EXPECT_TRUE(wrenches.validate());
}

TEST(Wrenches, NameThePlateThatActsNowhere) {
  auto wrenches = one_plate();
  wrenches.items[0].force[5] = 3.0;
  EXPECT_THAT(wrenches.validate().error().message, HasSubstr("'plate 1' acts in frame 1"));
  wrenches.items[0].force[5] = 0.0;
  wrenches.items[0].moment[4] = 3.0;
  EXPECT_THAT(wrenches.validate().error().message, HasSubstr("'plate 1' acts in frame 1"));
}

TEST(Wrenches, SayWhichShapeIsWrong) {
  auto wrenches = one_plate();
  wrenches.items[0].moment.pop_back();
  EXPECT_THAT(wrenches.validate().error().message, HasSubstr("5 numbers of moment; need 6"));
  wrenches = one_plate();
  wrenches.time.rate_hz = 0.0;
  EXPECT_THAT(wrenches.validate().error().message, HasSubstr("rate of 0 Hz"));
}

}  // namespace
}  // namespace kinemark::data
