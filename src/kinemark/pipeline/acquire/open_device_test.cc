// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/open_device.h"

#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <iterator>
#include <string>

#include "kinemark/io/recording/counts_recording.h"
#include "support/scratch.h"

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

std::ptrdiff_t open_handles() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

TEST(OpenDevice, AThousandTimesLeavesNoHandle) {
  const testing_support::ScratchFolder scratch;
  const auto file = scratch / "trial.mcap";
  ASSERT_TRUE(io::write_counts(
      file, data::Counts::zeros({"hand"}, {"A"}, {.rate_hz = 100.0, .frames = 3}, false), {}, false));
  const auto before = open_handles();
  for (int i = 0; i < 1000; ++i)
    for (const std::string& uri : {std::string("sim:rig?leds=1&fast"), "replay:" + file.string() + "?fast"}) {
      const auto device = open_device(uri).value();
      ASSERT_TRUE(device->configure({}) && device->start());
      stream::Block block;
      ASSERT_TRUE(device->read(block, std::chrono::milliseconds(1)));
      ASSERT_TRUE(device->stop());
    }
  EXPECT_EQ(open_handles(), before);
}

TEST(EnumerateDevices, GivesAddressesThatCanBeOpened) {
  const auto devices = enumerate_devices();
  ASSERT_FALSE(devices.empty());
  EXPECT_EQ(devices.back().uri, "sim:rig");
  EXPECT_TRUE(open_device("sim:rig"));  // what is plugged in here is left alone
}

}  // namespace
}  // namespace kinemark::pipeline
