// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/serial_device.h"

#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <filesystem>

#include "kinemark/stream/serial/testing/pty_rig.h"
#include "support/scratch.h"

namespace kinemark::stream {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using testing::PtyRig;
using testing::telling_counts;

constexpr milliseconds kLong(10'000);

ScanPlan two_leds(bool dark = false) {
  return {.leds = {"hand", "wrist"},
          .cameras = {"A", "B"},
          .rate_hz = 100.0,
          .timing = {.conversion_s = 64e-6, .dark_slot = dark},
          .intensity = {}};
}

class SerialDeviceTest : public ::testing::Test {
 protected:
  /// Open, with a plan granted and started.
  std::unique_ptr<Device> running(bool dark = false) {
    auto device = open_serial(rig_.path()).value();
    EXPECT_TRUE(device->configure(two_leds(dark)));
    EXPECT_TRUE(device->start());
    return device;
  }

  testing_support::ScratchFolder scratch_;
  PtyRig rig_{scratch_ / "line"};
  Block block_;
};

TEST_F(SerialDeviceTest, SaysWhatItIsAndGrantsAPlan) {
  auto device = open_serial(rig_.path()).value();
  EXPECT_EQ(device->capabilities().name, "pty 0.1");
  const auto granted = device->configure(two_leds());
  ASSERT_TRUE(granted) << granted.error().message;
  EXPECT_DOUBLE_EQ(granted->plan.rate_hz, 100.0);
  EXPECT_EQ(granted->layout.leds.size(), 2U);
  auto fast = two_leds();
  fast.rate_hz = 1000.0;
  const auto refused = device->configure(fast);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::usage);
  EXPECT_THAT(refused.error().message, HasSubstr("do not fit: the highest rate is 484.4 Hz"));
}

TEST_F(SerialDeviceTest, AsksAgainWhereTheLineDamagesAnAnswer) {
  auto device = open_serial(rig_.path()).value();
  rig_.damage(1);
  ASSERT_TRUE(device->configure(two_leds()));
  rig_.damage(1);
  ASSERT_TRUE(device->start());
  rig_.wait_for("stop");  // what was begun unheard is ended first
  rig_.wait_for("start", 2);
  rig_.send_frames(0, 3);
  ASSERT_EQ(device->read(block_, kLong).value(), ReadResult::block);
  EXPECT_EQ(block_.first_frame, 0);
}

TEST_F(SerialDeviceTest, GivesFramesInBlocksWithTheTimesOfTheHost) {
  auto device = running();
  rig_.send_frames(0, 5);
  std::int64_t frames = 0;
  while (frames < 5) {
    ASSERT_EQ(device->read(block_, kLong), ReadResult::block);
    EXPECT_EQ(block_.first_frame, frames);
    EXPECT_FALSE(block_.gap || block_.overflow || block_.saturated);
    EXPECT_LE(block_.host_before_ns, block_.host_after_ns);
    const auto expected = telling_counts(2, 2, static_cast<std::uint32_t>(frames));
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), block_.counts.begin()));
    EXPECT_EQ(block_.counts.size(), static_cast<std::size_t>(block_.frames) * 16);
    EXPECT_EQ(block_.flags.size(), static_cast<std::size_t>(block_.frames) * 4);
    frames += block_.frames;
  }
  EXPECT_EQ(device->read(block_, milliseconds(0)), ReadResult::timeout);
  EXPECT_EQ(block_.frames, 0);
}

TEST_F(SerialDeviceTest, EndsABlockWhereFramesAreMissingAndSaysWhoLostThem) {
  auto device = running();
  testing::Bytes sent = testing::telling_frame(2, 2, 0);
  for (const auto& [number, dropped] : {std::pair{1U, 0U}, {4U, 2U}, {6U, 2U}})
    for (const auto byte : testing::telling_frame(2, 2, number, dropped)) sent.push_back(byte);
  rig_.send(sent);
  std::vector<std::int64_t> first;
  std::vector<bool> gap, overflow;
  for (std::int64_t next = 0; next < 7; next = block_.first_frame + block_.frames) {
    ASSERT_EQ(device->read(block_, kLong), ReadResult::block);
    first.push_back(block_.first_frame);
    gap.push_back(block_.gap);
    overflow.push_back(block_.overflow);
  }
  while (first.size() > 3) {  // 0 and 1 may have come apart
    first.erase(first.begin() + 1);
    gap.erase(gap.begin() + 1);
    overflow.erase(overflow.begin() + 1);
  }
  EXPECT_THAT(first, ::testing::ElementsAre(0, 4, 6));
  EXPECT_THAT(gap, ::testing::ElementsAre(false, true, true));
  EXPECT_THAT(overflow, ::testing::ElementsAre(false, true, false));
}

TEST_F(SerialDeviceTest, PutsTheDarkSlotApartAndFlagsTheHighestCode) {
  auto device = running(true);
  auto counts = telling_counts(3, 2, 0);
  counts[5] = 1023;
  counts[17] = 900;
  rig_.send(testing::frame_bytes(3, 2, 0, 0, counts));
  ASSERT_EQ(device->read(block_, kLong), ReadResult::block);
  EXPECT_EQ(block_.dark.size(), 8U);
  EXPECT_EQ(block_.dark[1], 900);
  EXPECT_THAT(block_.flags, ::testing::ElementsAre(0, data::kCountSaturated, 0, 0));
  EXPECT_TRUE(block_.saturated);
}

TEST_F(SerialDeviceTest, StopsAndStartsAgainWithFrameZero) {
  auto device = running();
  for (int again = 0; again < 3; ++again) {
    if (again > 0) {
      ASSERT_TRUE(device->start());
    }
    rig_.send_frames(0, 1);
    ASSERT_EQ(device->read(block_, kLong), ReadResult::block);
    EXPECT_EQ(block_.first_frame, 0);
    EXPECT_FALSE(block_.gap);
    ASSERT_TRUE(device->stop());
  }
  EXPECT_TRUE(device->stop());
}

TEST_F(SerialDeviceTest, GoesOnWithAGapWhenTheRigIsBack) {
  auto device = running();
  rig_.send_frames(0, 3);
  std::int64_t last = -1;
  while (last < 2) {
    ASSERT_EQ(device->read(block_, kLong), ReadResult::block);
    last = block_.first_frame + block_.frames - 1;
  }
  rig_.unplug();
  EXPECT_EQ(device->read(block_, kLong).error().code, Code::device);
  EXPECT_THAT(device->reopen().error().message, HasSubstr("no such device"));
  EXPECT_THAT(device->read(block_, kLong).error().message, HasSubstr("the rig is gone"));
  EXPECT_THAT(device->write_digital(0, true).error().message, HasSubstr("the rig is gone"));
  rig_.plug_in();
  const auto back = device->reopen();
  ASSERT_TRUE(back) << back.error().message;
  rig_.send_frames(0, 1);
  ASSERT_EQ(device->read(block_, kLong), ReadResult::block);
  EXPECT_TRUE(block_.gap || block_.first_frame == last + 1);
  EXPECT_GT(block_.first_frame, last);
}

TEST_F(SerialDeviceTest, SaysThatItIsGoneWhateverIsAskedOfIt) {
  auto device = running();
  rig_.unplug();
  for (int again = 0; again < 2; ++again) {  // before and after it was looked for
    EXPECT_EQ(device->read(block_, kLong).error().code, Code::device);
    EXPECT_EQ(device->write_digital(0, true).error().code, Code::device);
    EXPECT_EQ(device->write_analog(0, 1.0).error().code, Code::usage);  // which it never had
    EXPECT_EQ(device->reopen().error().code, Code::device);
  }
  EXPECT_EQ(device->stop().error().code, Code::device);
  EXPECT_TRUE(device->stop());
  EXPECT_EQ(device->start().error().code, Code::device);
  EXPECT_EQ(device->configure(two_leds()).error().code, Code::device);
  EXPECT_EQ(device->start().error().code, Code::device);
  rig_.plug_in();
  ASSERT_TRUE(device->reopen());
  EXPECT_TRUE(device->start());
}

TEST_F(SerialDeviceTest, SaysThatItIsGoneBeforeItWasLookedFor) {
  auto device = running();
  ASSERT_TRUE(device->stop());
  rig_.unplug();
  EXPECT_EQ(device->start().error().code, Code::device);
  EXPECT_EQ(device->configure(two_leds()).error().code, Code::device);
  EXPECT_EQ(device->write_digital(0, true).error().code, Code::device);
}

std::int64_t now_ns() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

TEST_F(SerialDeviceTest, MissesWhatPassedSinceTheLastFrameHoweverFastItsClockHadRun) {
  auto device = running();
  rig_.send_frames(49'999, 1);  // 500 s by its clock
  ASSERT_EQ(device->read(block_, kLong), ReadResult::block);
  const auto last_ns = block_.host_after_ns, next = block_.first_frame + 1;
  rig_.unplug();
  EXPECT_FALSE(device->read(block_, kLong));
  rig_.plug_in();
  ASSERT_TRUE(device->reopen());
  const double most_s = 1e-9 * static_cast<double>(now_ns() - last_ns);
  rig_.send_frames(0, 1);
  ASSERT_EQ(device->read(block_, kLong), ReadResult::block);
  EXPECT_TRUE(block_.gap);
  EXPECT_GE(block_.first_frame, next + 1);
  EXPECT_LE(block_.first_frame, next + 1 + std::llround(100.0 * most_s));
}

TEST_F(SerialDeviceTest, DoesNotWaitForItsTriggerInTheMiddleOfARecording) {
  auto device = open_serial(rig_.path()).value();
  auto plan = two_leds();
  plan.trigger = Trigger::digital_line;
  ASSERT_TRUE(device->configure(plan));
  ASSERT_TRUE(device->start());
  const auto come_back = [&] {
    rig_.unplug();
    EXPECT_FALSE(device->read(block_, kLong));
    rig_.plug_in();
    EXPECT_TRUE(device->reopen());
    rig_.send_frames(0, 1);
    EXPECT_EQ(device->read(block_, kLong), ReadResult::block);
  };
  const std::string waits = "plan 2 0 20000 624 128 416 1", goes_on = "plan 2 0 20000 624 128 416 0";
  come_back();
  rig_.wait_for(waits, 2);
  EXPECT_EQ(block_.first_frame, 0);  // what passed before the trigger is not lost
  EXPECT_FALSE(block_.gap);
  come_back();
  rig_.wait_for(goes_on);
  EXPECT_GT(block_.first_frame, 1);
  EXPECT_TRUE(block_.gap);
  ASSERT_TRUE(device->stop());
  ASSERT_TRUE(device->start());  // a new recording waits again
  rig_.wait_for(waits, 3);
}

TEST_F(SerialDeviceTest, IsNotTakenForTheSameWhenAnotherComesBack) {
  auto device = running();
  rig_.unplug();
  rig_.facts.replace(rig_.facts.find("name=pty"), 8, "name=odd");
  rig_.plug_in();
  EXPECT_THAT(device->reopen().error().message, HasSubstr("is odd now, and was pty"));
}

TEST_F(SerialDeviceTest, SetsOutputsAndRefusesOthers) {
  auto device = running();
  ASSERT_TRUE(device->write_digital(1, true));
  rig_.wait_for("out 1 1");
  EXPECT_EQ(device->write_digital(2, true).error().code, Code::usage);
  EXPECT_THAT(device->write_analog(0, 1.0).error().message, HasSubstr("no analog output 0"));
}

TEST_F(SerialDeviceTest, TellsALineWithoutARigFromOne) {
  rig_.facts = "";
  const auto silent = open_serial(rig_.path());
  ASSERT_FALSE(silent);
  EXPECT_THAT(silent.error().message, HasSubstr("no rig answers"));
  rig_.facts = "rig name=new version=9 protocol=7";
  EXPECT_THAT(open_serial(rig_.path()).error().message, HasSubstr("protocol '7'"));
}

TEST_F(SerialDeviceTest, StopsTheRigWhenItIsClosed) {
  running().reset();
  rig_.wait_for("stop", 2);
}

}  // namespace
}  // namespace kinemark::stream
