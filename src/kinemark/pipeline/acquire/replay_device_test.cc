// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/replay_device.h"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <vector>

#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/pipeline/acquire/open_device.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using std::chrono::milliseconds;
using stream::Block;
using stream::ReadResult;
using testing::ElementsAre;
using testing::HasSubstr;

/// Time passes when somebody sleeps.
class SetClock final : public stream::HostClock {
 public:
  [[nodiscard]] std::int64_t now_ns() const override { return now; }
  void sleep_until(std::int64_t time_ns) override { now = std::max(now, time_ns); }
  std::int64_t now = 1'000;
};

class Replay : public testing::Test {
 protected:
  testing_support::ScratchFolder scratch_;
  std::filesystem::path file_ = scratch_ / "trial?.mcap";
  std::shared_ptr<SetClock> clock_ = std::make_shared<SetClock>();
  data::Counts layout_ = data::Counts::zeros({"hand"}, {"A", "B"}, {.rate_hz = 100.0}, true);

  void SetUp() override {
    for (double& time_s : layout_.conversion_time_s) time_s = 1e-3;
    for (double& time_s : layout_.dark_time_s) time_s = 2e-3;
    auto writer = io::CountsWriter::create(file_, layout_).value();
    for (const std::int64_t f : {0, 1, 2, 5, 6, 7, 8}) {
      const std::vector<std::int16_t> counts(8, static_cast<std::int16_t>(100 * f)), dark(8, 16);
      const std::vector<std::uint8_t> flags{0, static_cast<std::uint8_t>(f == 6 ? 1 : 0)};
      ASSERT_TRUE(writer.push({.frame = f,
                               .time_s = 0.01 * static_cast<double>(f),
                               .counts = counts,
                               .flags = flags,
                               .dark = dark}));
    }
    ASSERT_TRUE(writer.close());
  }
  std::unique_ptr<stream::Device> open(const std::string& settings = "") {
    return open_device("replay:" + file_.string() + settings, 1, clock_).value();
  }
};

TEST_F(Replay, GivesTheFramesOfTheFileWithTheirGaps) {
  const auto device = open("?fast");
  EXPECT_EQ(device->capabilities().speed, 0.0);
  const auto granted = device->configure({}).value();
  EXPECT_EQ(granted.layout.conversion_time_s, layout_.conversion_time_s);
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(device->start());
    Block block;
    ASSERT_EQ(device->read(block, milliseconds(0)).value(), ReadResult::block);
    EXPECT_EQ(block.first_frame, 0);
    EXPECT_EQ(block.frames, 3);
    EXPECT_FALSE(block.gap || block.saturated);
    EXPECT_EQ(block.dark.size(), 24U);
    ASSERT_EQ(device->read(block, milliseconds(0)).value(), ReadResult::block);
    EXPECT_EQ(block.first_frame, 5);
    EXPECT_TRUE(block.gap && block.saturated);
    EXPECT_EQ(block.counts.front(), 500);
    EXPECT_EQ(block.counts.back(), 800);
    EXPECT_EQ(device->read(block, milliseconds(0)).value(), ReadResult::ended);
    ASSERT_TRUE(device->stop());
  }
}

TEST_F(Replay, FramesComeAtTheRateOfTheFileOrAtTheOneAskedFor) {
  for (const auto& [settings, rate_hz] : {std::pair{"", 100.0}, std::pair{"?rate=50", 50.0}}) {
    const auto device = open(settings);
    EXPECT_EQ(device->configure({}).value().plan.rate_hz, rate_hz);
    ASSERT_TRUE(device->start());
    const auto begin = clock_->now;
    Block block;
    std::vector<std::int64_t> came_ms;
    EXPECT_EQ(device->read(block, milliseconds(2)).value(), ReadResult::timeout);
    while (true) {
      const auto result = device->read(block, milliseconds(1000)).value();
      if (result == ReadResult::ended) break;
      came_ms.push_back((clock_->now - begin) / 1'000'000);
      EXPECT_EQ(block.frames, 1);
    }
    const auto ms = static_cast<std::int64_t>(1000.0 / rate_hz);
    EXPECT_THAT(came_ms, ElementsAre(ms, 2 * ms, 3 * ms, 6 * ms, 7 * ms, 8 * ms, 9 * ms));
  }
  EXPECT_DOUBLE_EQ(open("?rate=50")->configure({}).value().layout.conversion_time_s.front(), 2e-3);
}

TEST_F(Replay, WaitsForAHostThatDoesNotRead) {
  const auto device = open();
  ASSERT_TRUE(device->configure({}));
  ASSERT_TRUE(device->start());
  clock_->now += 100'000'000'000;
  Block block;
  ASSERT_EQ(device->read(block, milliseconds(0)).value(), ReadResult::block);
  EXPECT_EQ(block.frames, 3);
  EXPECT_FALSE(block.overflow);
}

TEST_F(Replay, RefusesPlansOfAnotherRecording) {
  const auto device = open();
  const auto said = [&](const stream::ScanPlan& plan) {
    const auto granted = device->configure(plan);
    EXPECT_FALSE(granted);
    return granted ? "" : granted.error().message;
  };
  EXPECT_THAT(said({.leds = {"a", "b"}}), HasSubstr("holds 1 LEDs and 2 cameras"));
  EXPECT_THAT(said({.rate_hz = 50.0}), HasSubstr("recorded at 100 Hz"));
  EXPECT_THAT(said({.intensity = {0.5}}), HasSubstr("cannot be set"));
  EXPECT_EQ(device->configure({.leds = {"thumb"}, .rate_hz = 100.0}).value().layout.leds.front(), "thumb");
  EXPECT_FALSE(device->write_analog(0, 0.0));
  EXPECT_FALSE(device->write_digital(0, true));
  EXPECT_TRUE(device->reopen());
}

TEST_F(Replay, NeedsARecording) {
  EXPECT_FALSE(open_device("replay:"));
  EXPECT_EQ(open_device("replay:absent.mcap").error().code, Code::io);
  EXPECT_THAT(open_device("replay:" + file_.string() + "?speed=2").error().message, HasSubstr("'speed'"));
}

}  // namespace
}  // namespace kinemark::pipeline
