// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/desk/plan_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::pipeline {
namespace {

TEST(PlanOf, TakesSlotsAndCamerasOfTheDevice) {
  stream::DeviceCapabilities device;
  device.cameras = 3;
  device.fastest.settle_s = 1e-3;
  Wanted wanted;
  wanted.duration_s = "2.5";
  device.most_leds = 2;
  const auto plan = plan_of(wanted, device);
  ASSERT_TRUE(plan);
  EXPECT_THAT(plan->scan.cameras, testing::ElementsAre("A", "B", "C"));
  EXPECT_EQ(plan->scan.timing.settle_s, 1e-3);
  EXPECT_EQ(plan->scan.rate_hz, 0.0);
  EXPECT_EQ(plan->duration_s, 2.5);
  EXPECT_THAT(plan->scan.leds, testing::ElementsAre("1", "2"));
  device.most_leds = 0;  // they run by themselves
  EXPECT_THAT(plan_of(wanted, device)->scan.leds, testing::ElementsAre("1"));
}

}  // namespace
}  // namespace kinemark::pipeline
