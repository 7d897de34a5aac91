// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/led_names.h"

#include <gmock/gmock.h>

namespace kinemark::pipeline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(ParseLeds, TakesACountOrNames) {
  stream::DeviceCapabilities device;  // that says nothing of its LEDs
  EXPECT_THAT(*parse_leds("2", device), ElementsAre("1", "2"));
  EXPECT_THAT(*parse_leds("", device), ElementsAre("1"));
  EXPECT_THAT(*parse_leds(" hand , left elbow", device), ElementsAre("hand", "left elbow"));
  for (const char* wrong : {"0", "65", "2.5", "-1", "1e300", "a,", ",a", "a,b,a"})
    EXPECT_FALSE(parse_leds(wrong, device)) << wrong;
}

TEST(ParseLeds, TakesTheNamesThatTheDeviceHas) {
  stream::DeviceCapabilities device;
  device.leds = {"hand", "wrist"};
  device.most_leds = 2;
  EXPECT_THAT(*parse_leds("1", device), ElementsAre("hand"));
  EXPECT_THAT(*parse_leds(" ", device), ElementsAre("hand", "wrist"));
  EXPECT_THAT(parse_leds("3", device).error().message, HasSubstr("3 were asked for; the device has 2"));
}

}  // namespace
}  // namespace kinemark::pipeline
