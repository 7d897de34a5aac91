// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/device.h"

#include <gmock/gmock.h>

namespace kinemark::stream {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(OwnNames, AreThoseOfTheDeviceThenNumbersAndLetters) {
  EXPECT_THAT(own_names({}, 3, false), ElementsAre("1", "2", "3"));
  EXPECT_THAT(own_names({}, 2, true), ElementsAre("A", "B"));
  EXPECT_THAT(own_names({"hand"}, 2, false), ElementsAre("hand", "2"));
  EXPECT_THAT(own_names({"hand", "wrist"}, 1, false), ElementsAre("hand"));
  EXPECT_THAT(own_names({"left"}, 0, true), IsEmpty());
  EXPECT_EQ(own_names({}, 27, true).back(), "27");
}

TEST(WithNames, GivesThoseThatAreMissing) {
  DeviceCapabilities device;
  device.most_leds = 2;
  device.cameras = 2;
  ScanPlan plan = with_names({}, device);
  EXPECT_THAT(plan.leds, ElementsAre("1", "2"));
  EXPECT_THAT(plan.cameras, ElementsAre("A", "B"));
  plan.leds = {"hand"};
  EXPECT_THAT(with_names(plan, device).leds, ElementsAre("hand"));
  device.most_leds = 0;  // LEDs run by themselves
  EXPECT_THAT(with_names({}, device).leds, ElementsAre("1"));
}

TEST(UsualTiming, IsThatOf1986UnlessTheDeviceIsSlower) {
  DeviceCapabilities device;
  device.fastest = {.settle_s = 20e-6, .conversion_s = 64e-6, .off_s = 30e-6};
  const data::SlotTiming timing = usual_timing(device);
  EXPECT_EQ(timing.settle_s, 320e-6);
  EXPECT_EQ(timing.conversion_s, 64e-6);
  EXPECT_EQ(timing.off_s, 200e-6);
  EXPECT_FALSE(timing.dark_slot);
}

}  // namespace
}  // namespace kinemark::stream
