// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/recorder.h"

#include <gmock/gmock.h>

#include <cmath>
#include <condition_variable>
#include <fstream>
#include <memory>
#include <mutex>

#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/pipeline/acquire/open_device.h"
#include "kinemark/pipeline/acquire/testing/played_device.h"

namespace kinemark::pipeline {
namespace {

using std::chrono::milliseconds;
using stream::Block;
using stream::ReadResult;
using ::testing::ElementsAre;
using testing::PlayedDevice;

class Recording : public testing::RecorderTest {};

TEST_F(Recording, KeepsEveryFrameOfASimulatedRigWithItsTime) {
  const auto device = open_device("sim:rig?leds=4&seconds=5&fast").value();
  const auto done = record(*device, {.metadata = {{"acquisition", {{"subject", "S1"}}}}}, {.rate_hz = 200.0});
  EXPECT_EQ(done.end, RecorderEnd::complete);
  EXPECT_EQ(done.progress.frames, 1000);
  EXPECT_EQ(done.progress.acknowledged, 1000);
  EXPECT_FALSE(done.clock);
  expect_adds_up(done.progress);
  const auto read = io::read_counts(file_).value();
  EXPECT_EQ(read.end, io::RecordingEnd::closed);
  EXPECT_EQ(read.counts.frames(), 1000);
  EXPECT_THAT(read.warnings, ElementsAre());
  EXPECT_EQ(value(read, "acquisition", "subject"), "S1");
  EXPECT_EQ(value(read, "acquisition_end", "acknowledged"), "1000");
  EXPECT_EQ(value(read, "acquisition_end", "ended"), "complete");
  EXPECT_EQ(done.lit.size(), 8U);
  EXPECT_EQ(done.lit.front().frames, 1000);
}

TEST_F(Recording, EndsWithTheFramesThatWereAskedFor) {
  const auto device = open_device("sim:rig?leds=1&fast").value();
  const auto done = record(*device, {.frames = 777});
  EXPECT_EQ(done.end, RecorderEnd::complete);
  EXPECT_EQ(done.progress.frames, 777);
  EXPECT_EQ(io::read_counts(file_).value().counts.frames(), 777);
}

TEST_F(Recording, StopsWhenAnotherThreadAsksForIt) {
  const auto device = open_device("sim:rig?leds=1&fast").value();
  const auto granted = device->configure({}).value();
  const auto recorder = Recorder::start(*device, granted, {.file = file_}).value();
  while (recorder->progress().acknowledged < 1000) EXPECT_FALSE(recorder->wait_for(milliseconds(1)));
  recorder->stop();
  EXPECT_TRUE(recorder->wait_for(milliseconds(60'000)));
  const auto done = recorder->finish();
  EXPECT_EQ(done.end, RecorderEnd::stopped);
  EXPECT_EQ(done.progress.acknowledged, done.progress.frames);
  EXPECT_EQ(io::read_counts(file_).value().counts.frames(), done.progress.frames);
}

TEST_F(Recording, ADeviceThatDoesNotStopSpoilsNothing) {
  PlayedDevice device;
  device.ends = fail(Code::device, "played: is gone");
  device.play = [](PlayedDevice& d, Block& block) -> Result<ReadResult> { return d.give(block, 10); };
  const auto whole = record(device, {.frames = 100});
  EXPECT_EQ(whole.end, RecorderEnd::complete);
  EXPECT_FALSE(whole.error);
  EXPECT_EQ(whole.progress.acknowledged, 100);
  const auto read = io::read_counts(file_).value();
  EXPECT_EQ(value(read, "acquisition_end", "ended"), "complete");
  EXPECT_EQ(value(read, "acquisition_end", "not_stopped"), "played: is gone");

  const auto plan = device.configure({}).value();
  const auto recorder = Recorder::start(device, plan, {.file = scratch_ / "b.mcap"}).value();
  recorder->stop();
  const auto cut = recorder->finish();
  EXPECT_EQ(cut.end, RecorderEnd::stopped);
  EXPECT_FALSE(cut.error);
}

TEST_F(Recording, LeftWithoutFinishIsAsAfterAKill) {
  const auto device = open_device("sim:rig?leds=1&fast").value();
  {
    const auto recorder = Recorder::start(*device, device->configure({}).value(), {.file = file_}).value();
    while (recorder->progress().acknowledged < 10) EXPECT_FALSE(recorder->wait_for(milliseconds(1)));
  }
  EXPECT_EQ(io::read_counts(file_).value().end, io::RecordingEnd::open);
}

TEST_F(Recording, BeginsWithTheFrameInWhichALedLightsUp) {
  PlayedDevice device;
  device.play = [](PlayedDevice& d, Block& block) -> Result<ReadResult> { return d.give(block, 7); };
  const auto done = record(device, {.frames = 20, .begin = BrightnessTrigger{.led = 0, .counts = 4 * 100.0}});
  EXPECT_EQ(done.progress.frames, 20);
  EXPECT_EQ(done.progress.dropped_by_device, 0);
  const auto read = io::read_counts(file_).value();
  EXPECT_EQ(read.counts.frames(), 20);
  EXPECT_EQ(read.counts.at(0, 0, 0)[0], 100.0);
  EXPECT_EQ(read.counts.at(19, 0, 0)[0], 119.0);
}

/// Holds its thread until the test lets it go.
class SlowFollower final : public BlockFollower {
 public:
  void take(const Block& block) override {
    std::unique_lock lock(mutex);
    frames += block.frames;
    free.wait(lock, [this] { return open; });
  }
  void let_go() {
    const std::scoped_lock lock(mutex);
    open = true;
    free.notify_all();
  }
  std::mutex mutex;
  std::condition_variable free;
  bool open = false;
  std::int64_t frames = 0;
};

TEST_F(Recording, AFollowerThatIsSlowMissesBlocksAndNobodyElseDoesInThreads) {
  PlayedDevice device;
  const auto follower = std::make_shared<SlowFollower>();
  device.play = [&](PlayedDevice& d, Block& block) -> Result<ReadResult> {
    if (d.next >= 90'000) follower->let_go();
    return d.next >= 100'000 ? Result<ReadResult>(ReadResult::ended) : d.give(block, 100);
  };
  const auto done = record(device, {.followers = {follower}});
  EXPECT_EQ(done.progress.acknowledged, 100'000);
  EXPECT_GT(done.progress.missed_by_followers, 0);
  EXPECT_EQ(follower->frames + done.progress.missed_by_followers, 100'000);
}

TEST_F(Recording, FindsTheRateOfTheDevicesClock) {
  PlayedDevice device(1.0);
  device.play = [](PlayedDevice& d, Block& block) -> Result<ReadResult> {
    const auto result = d.give(block, 1);
    block.host_after_ns = std::llround(static_cast<double>(d.next) * 1e7 / 1.0003);
    return result;
  };
  const auto done = record(device, {.frames = 6000, .ring_s = 100.0});
  ASSERT_TRUE(done.clock);
  EXPECT_NEAR(done.clock->ppm_fast, 300.0, 0.01);
  EXPECT_NE(value(io::read_counts(file_).value(), "acquisition_end", "clock_rate_hz"), "absent");
}

TEST_F(Recording, FindsTheRateOfAClockWhoseFramesWereNumberedAnew) {
  PlayedDevice device(1.0);
  std::int64_t real = 0;  // frames by the device's clock, which numbers that the host gives do not follow
  device.play = [&](PlayedDevice& d, Block& block) -> Result<ReadResult> {
    block.renumbered = real == 2000 || real == 4000;
    if (block.renumbered) d.next += 7;
    const auto result = d.give(block, 1);
    block.host_after_ns = std::llround(static_cast<double>(++real) * 1e7 / 1.0003);
    return result;
  };
  const auto done = record(device, {.frames = 6014, .ring_s = 100.0});
  ASSERT_TRUE(done.clock);
  EXPECT_NEAR(done.clock->ppm_fast, 300.0, 0.01);
  EXPECT_NEAR(done.clock->span_s, 20.0, 1.0);
  EXPECT_EQ(done.progress.reopened, 0);
}

TEST_F(Recording, MakesNoFileWhereItCannotStart) {
  PlayedDevice device;
  device.starts = fail(Code::device, "busy");
  const auto plan = device.configure({}).value();
  EXPECT_EQ(Recorder::start(device, plan, {.file = file_}).error().message, "busy");
  EXPECT_FALSE(std::filesystem::exists(file_));
  device.starts = Status();
  EXPECT_EQ(Recorder::start(device, plan, {.file = scratch_ / "absent" / "x.mcap"}).error().code, Code::io);
  EXPECT_EQ(device.stops, 1);
}

TEST_F(Recording, LeavesAnEarlierRecordingAsItIsWhereTheDeviceDoesNotStart) {
  std::ofstream(file_) << "an earlier recording";
  PlayedDevice device;
  device.starts = fail(Code::device, "busy");
  const auto plan = device.configure({}).value();
  EXPECT_FALSE(Recorder::start(device, plan, {.file = file_, .recording = {.force = true}}));
  std::string kept;
  std::getline(std::ifstream(file_), kept);
  EXPECT_EQ(kept, "an earlier recording");
  EXPECT_EQ(device.stops, 0);
}

TEST_F(Recording, WithoutAFileKeepsFiguresAlone) {
  const auto device = open_device("sim:rig?leds=1&seconds=1&fast").value();
  const auto granted = device->configure({}).value();
  const auto done = Recorder::start(*device, granted, {}).value()->finish();
  EXPECT_EQ(done.progress.acknowledged, done.progress.frames);
  EXPECT_EQ(done.lit.front().frames, done.progress.frames);
}

}  // namespace
}  // namespace kinemark::pipeline
