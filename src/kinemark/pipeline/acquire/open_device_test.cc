// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/open_device.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace kinemark::pipeline {
namespace {

using testing::HasSubstr;

TEST(OpenDevice, NamesTheAddressesThatThereAre) {
  for (const char* uri : {"", "walk.c3d", "usb:1", "sim"}) {
    const auto device = open_device(uri);
    ASSERT_FALSE(device) << uri;
    EXPECT_EQ(device.error().code, Code::usage);
    EXPECT_THAT(device.error().message, HasSubstr("sim:rig, replay:FILE.mcap"));
  }
  EXPECT_THAT(open_device("sim:walk").error().message, HasSubstr("no simulated device that gives counts"));
}

TEST(OpenDevice, TheSeedOfTheAddressCountsMost) {
  EXPECT_EQ(open_device("sim:rig", 5).value()->configure({}).value().facts.at("seed"), "5");
  EXPECT_EQ(open_device("sim:rig?seed=7", 5).value()->configure({}).value().facts.at("seed"), "7");
}

TEST(EnumerateDevices, GivesAddressesThatCanBeOpened) {
  const auto devices = enumerate_devices();
  ASSERT_FALSE(devices.empty());
  EXPECT_EQ(devices.back().uri, "sim:rig");
  for (const auto& device : devices)
    if (device.state.empty()) EXPECT_TRUE(open_device(device.uri)) << device.uri;
}

}  // namespace
}  // namespace kinemark::pipeline
