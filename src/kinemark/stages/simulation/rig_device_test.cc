// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/rig_device.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <vector>

namespace kinemark::simulation {
namespace {

using std::chrono::milliseconds;
using stream::Block;
using stream::ReadResult;
using testing::HasSubstr;

/// Time passes when somebody sleeps, or as the test says.
class SetClock final : public stream::HostClock {
 public:
  [[nodiscard]] std::int64_t now_ns() const override { return now; }
  void sleep_until(std::int64_t time_ns) override { now = std::max(now, time_ns); }
  std::int64_t now = 5'000'000'000;
};

struct Desk {
  std::shared_ptr<SetClock> clock = std::make_shared<SetClock>();
  std::unique_ptr<RigDevice> device;
};

Desk desk(const RigDeviceOptions& options, const RigScene& scene = signing_arm(), bool dark_slot = false) {
  Desk out;
  out.device =
      RigDevice::create(draw_rig({.seed = 3, .dark_slot = dark_slot}).value(), scene, options, out.clock)
          .value();
  return out;
}

/// What came until the end.
struct Whole {
  std::vector<std::int16_t> counts, dark;
  std::vector<std::uint8_t> flags;
};
Whole read_all(RigDevice& device) {
  Whole out;
  Block block;
  for (std::int64_t next = 0; device.read(block, milliseconds(100)).value() != ReadResult::ended;) {
    if (block.frames == 0) continue;
    EXPECT_EQ(block.first_frame, next);
    next += block.frames;
    out.counts.insert(out.counts.end(), block.counts.begin(), block.counts.end());
    out.dark.insert(out.dark.end(), block.dark.begin(), block.dark.end());
    out.flags.insert(out.flags.end(), block.flags.begin(), block.flags.end());
    EXPECT_EQ(block.saturated, std::ranges::any_of(block.flags, [](auto f) { return f != 0; }));
    block.frames = 0;
  }
  return out;
}

void expect_same(const Whole& came, const data::Counts& recorded) {
  EXPECT_TRUE(std::ranges::equal(came.counts, recorded.counts));
  EXPECT_TRUE(std::ranges::equal(came.dark, recorded.dark));
  EXPECT_TRUE(std::ranges::equal(came.flags, recorded.flags));
}

TEST(RigDevice, GivesTheCountsOfARecordingToTheBit) {
  for (const double speed : {1.0, 7.0, 0.0})
    for (const bool dark : {false, true}) {
      const auto d =
          desk({.duration_s = 3.0, .seed = 9, .stream = 420, .speed = speed}, signing_arm(), dark).device;
      const auto granted = d->configure({.rate_hz = 150.0, .intensity = {0.5, 1.0, 1.0, 0.9}}).value();
      ASSERT_TRUE(d->start());
      const auto recorded =
          record(
              draw_rig({.seed = 3, .dark_slot = dark}).value(), signing_arm(),
              {.rate_hz = 150.0, .frames = 450, .intensity = {0.5, 1.0, 1.0, 0.9}, .seed = 9, .stream = 420})
              .value();
      EXPECT_EQ(granted.layout.conversion_time_s, recorded.counts.conversion_time_s);
      EXPECT_EQ(granted.layout.rig_id, recorded.counts.rig_id);
      expect_same(read_all(*d), recorded.counts);
    }
}

TEST(RigDevice, GivesItAgainAfterStopAndStart) {
  const auto d = desk({.duration_s = 0.2, .speed = 0.0});
  ASSERT_TRUE(d.device->configure({}));
  ASSERT_TRUE(d.device->start());
  const auto first = read_all(*d.device);
  ASSERT_TRUE(d.device->stop());
  ASSERT_TRUE(d.device->start());
  EXPECT_EQ(read_all(*d.device).counts, first.counts);
}

TEST(RigDevice, AFrameIsThereOnceItHasEndedByItsOwnClock) {
  auto d = desk({.clock_ppm = 300.0});
  ASSERT_TRUE(d.device->configure({.rate_hz = 100.0}));
  ASSERT_TRUE(d.device->start());
  const auto begin = d.clock->now;
  Block block;
  EXPECT_EQ(d.device->read(block, milliseconds(5)).value(), ReadResult::timeout);
  EXPECT_EQ(d.clock->now, begin + 5'000'000);
  EXPECT_EQ(d.device->read(block, milliseconds(100)).value(), ReadResult::block);
  EXPECT_EQ(block.frames, 1);
  EXPECT_EQ(block.host_before_ns, begin + 5'000'000);
  EXPECT_NEAR(static_cast<double>(block.host_after_ns - begin), 1e7 / 1.0003, 1.0);
  d.clock->now = begin + 500'000'000;
  EXPECT_EQ(d.device->read(block, milliseconds(100)).value(), ReadResult::block);
  EXPECT_EQ(block.first_frame, 1);
  EXPECT_EQ(block.frames, 49);
  EXPECT_FALSE(block.gap || block.overflow);
}

TEST(RigDevice, KeepsFramesForASecondThenLosesTheOldest) {
  auto d = desk({});
  ASSERT_TRUE(d.device->configure({.rate_hz = 100.0}));
  ASSERT_TRUE(d.device->start());
  d.clock->now += 10'000'000'000;
  Block block;
  ASSERT_EQ(d.device->read(block, milliseconds(100)).value(), ReadResult::block);
  EXPECT_EQ(block.first_frame, 900);
  EXPECT_EQ(block.frames, 100);
  EXPECT_TRUE(block.overflow && block.gap);
  ASSERT_EQ(d.device->read(block, milliseconds(100)).value(), ReadResult::block);
  EXPECT_EQ(block.first_frame, 1000);
  EXPECT_FALSE(block.overflow || block.gap);
}

TEST(RigDevice, GoesOnWithItsNumbersOnceItsPlugIsBack) {
  auto d = desk({.unplug_at_s = 2.0, .unplug_for_s = 3.0});
  ASSERT_TRUE(d.device->configure({.rate_hz = 100.0}));
  ASSERT_TRUE(d.device->start());
  Block block;
  std::int64_t next = 0;
  auto result = d.device->read(block, milliseconds(100));
  for (; result; result = d.device->read(block, milliseconds(100))) next = block.first_frame + block.frames;
  EXPECT_EQ(next, 200);
  EXPECT_EQ(result.error().code, Code::device);
  EXPECT_THAT(result.error().message, HasSubstr("put its plug back"));
  EXPECT_EQ(d.device->reopen().error().code, Code::device);
  d.clock->now += 3'004'000'000;
  ASSERT_TRUE(d.device->reopen());
  ASSERT_EQ(d.device->read(block, milliseconds(100)).value(), ReadResult::block);
  EXPECT_EQ(block.first_frame, 500);
  EXPECT_TRUE(block.gap);
}

TEST(RigDevice, IsUnpluggedOnceWhenItIsAsFastAsItIsRead) {
  auto d = desk({.duration_s = 10.0, .speed = 0.0, .unplug_at_s = 2.0, .unplug_for_s = 3.0});
  ASSERT_TRUE(d.device->configure({.rate_hz = 100.0}));
  ASSERT_TRUE(d.device->start());
  Block block;
  std::int64_t frames = 0;
  int failures = 0;
  while (true) {
    const auto result = d.device->read(block, milliseconds(1));
    if (!result) {
      ++failures;
      ASSERT_TRUE(d.device->reopen());
    } else if (*result == ReadResult::ended) {
      break;
    } else {
      frames += block.frames;
    }
  }
  EXPECT_EQ(failures, 1);
  EXPECT_EQ(frames, 700);
}

TEST(RigDevice, LightsTheFirstLedsOfThePlanByTheirNames) {
  const auto d = desk({.duration_s = 1.0});
  EXPECT_EQ(d.device->capabilities().most_leds, 4);
  const auto granted = d.device->configure({.leds = {"a", "b"}, .cameras = {"left", "right"}}).value();
  EXPECT_EQ(granted.layout.leds, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(granted.layout.cameras, (std::vector<std::string>{"left", "right"}));
  EXPECT_NEAR(granted.plan.rate_hz, 1.0 / (2 * 904e-6), 1e-9);
  EXPECT_EQ(d.device->configure({}).value().layout.leds, signing_arm().leds);
}

TEST(RigDevice, RefusesWhatItCannotDoAndSaysWhatItCan) {
  const auto d = desk({});
  const auto said = [&](const stream::ScanPlan& plan) {
    const auto granted = d.device->configure(plan);
    EXPECT_FALSE(granted);
    return granted ? "" : granted.error().message;
  };
  EXPECT_THAT(said({.rate_hz = 400.0}), HasSubstr("276.5 frames per second at most"));
  EXPECT_THAT(said({.leds = {"1", "2", "3", "4", "5"}}), HasSubstr("the simulated scene has 4"));
  EXPECT_THAT(said({.leds = {"1", "1"}}), HasSubstr("1"));
  EXPECT_THAT(said({.cameras = {"A"}}), HasSubstr("the simulated rig has 2"));
  EXPECT_THAT(said({.intensity = {0.0, 1.0, 1.0, 1.0}}), HasSubstr("intensity 0"));
  EXPECT_THAT(said({.trigger = stream::Trigger::digital_line}), HasSubstr("no digital line"));
  EXPECT_FALSE(d.device->write_analog(0, 1.0));
  EXPECT_FALSE(d.device->write_digital(0, true));
}

TEST(RigDeviceOptions, AreChecked) {
  EXPECT_TRUE(RigDeviceOptions().check());
  EXPECT_FALSE(RigDeviceOptions{.rate_hz = -1.0}.check());
  EXPECT_FALSE(RigDeviceOptions{.clock_ppm = 2e5}.check());
  EXPECT_FALSE(RigDeviceOptions{.buffer_s = 0.0}.check());
  EXPECT_FALSE(RigDeviceOptions{.unplug_at_s = std::nan("")}.check());
}

}  // namespace
}  // namespace kinemark::simulation
