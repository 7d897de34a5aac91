// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a recorder keeps and counts when a device or a disk fails.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <memory>

#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/pipeline/acquire/open_device.h"
#include "kinemark/pipeline/acquire/recorder.h"
#include "kinemark/pipeline/acquire/testing/played_device.h"

namespace kinemark::pipeline {
namespace {

using std::chrono::milliseconds;
using stream::Block;
using stream::ReadResult;
using ::testing::HasSubstr;
using testing::PlayedDevice;

class RecorderTrouble : public testing::RecorderTest {};

/// A clock that a test moves on.
class HandClock final : public stream::HostClock {
 public:
  [[nodiscard]] std::int64_t now_ns() const override { return now; }
  void sleep_until(std::int64_t time_ns) override { now = std::max<std::int64_t>(now, time_ns); }
  std::atomic<std::int64_t> now = 1;
};

TEST_F(RecorderTrouble, CountsWhatTheDeviceDidNotGive) {
  PlayedDevice device;
  device.play = [](PlayedDevice& d, Block& block) -> Result<ReadResult> {
    if (d.next == 30) d.next = 45;
    if (d.next == 95) d.next = 120;
    return d.give(block, 10);
  };
  const auto done = record(device, {.frames = 100});
  EXPECT_EQ(done.progress.frames, 100);
  EXPECT_EQ(done.progress.dropped_by_device, 15 + 5);
  EXPECT_EQ(done.progress.dropped_here, 0);
  expect_adds_up(done.progress);
  EXPECT_EQ(device.stops, 1);
  const auto read = io::read_counts(file_).value();
  EXPECT_EQ(read.counts.frames(), 95);
  EXPECT_TRUE(read.counts.has_flag(30, 0, 0, data::kCountLost));
  EXPECT_FALSE(read.counts.has_flag(45, 0, 0, data::kCountLost));
  EXPECT_EQ(value(read, "gap", "first_frame"), "30");
  EXPECT_EQ(value(read, "gap", "frames"), "15");
  EXPECT_EQ(value(read, "gap", "dropped_by_device"), "15");
  EXPECT_EQ(value(read, "acquisition_end", "dropped_by_device"), "20");
}

/// A disk that is slow: the follower's test of the same ring; here the ring is small and the device fast.
TEST_F(RecorderTrouble, CountsWhatTheDiskWasTooSlowForInThreads) {
  PlayedDevice device(1.0);
  device.play = [](PlayedDevice& d, Block& block) -> Result<ReadResult> { return d.give(block, 1000); };
  const auto done = record(device, {.frames = 400'000, .ring_s = 0.01});
  EXPECT_EQ(done.progress.frames, 400'000);
  EXPECT_EQ(done.progress.dropped_by_device, 0);
  EXPECT_GT(done.progress.dropped_here, 0);
  EXPECT_GT(done.progress.fullest_ring, 0.9);
  expect_adds_up(done.progress);
  const auto read = io::read_counts(file_).value();
  std::int64_t lost = done.progress.frames - read.counts.frames();
  for (std::int64_t f = 0; f < read.counts.frames(); ++f)
    lost += read.counts.has_flag(f, 0, 0, data::kCountLost);
  EXPECT_EQ(lost, done.progress.dropped_here);
}

/// For its lifetime no file of this process may grow beyond `bytes`, as if the disk were full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &now);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST_F(RecorderTrouble, CountsWhatAFullDiskDidNotTakeInThreads) {
  for (const double speed : {0.0, 1.0}) {
    PlayedDevice device(speed);
    device.play = [](PlayedDevice& d, Block& block) -> Result<ReadResult> {
      if (d.next == 50) d.next = 60;
      return d.give(block, 10);
    };
    const FullDisk full(5000);
    const auto done = record(device, {.recording = {.force = true}});
    EXPECT_EQ(done.end, RecorderEnd::failed);
    ASSERT_TRUE(done.error);
    EXPECT_THAT(done.error->message, HasSubstr("File too large"));
    EXPECT_GT(done.progress.acknowledged, 0);
    EXPECT_GT(done.progress.dropped_here, 0);
    EXPECT_EQ(done.progress.dropped_by_device, 10);
    expect_adds_up(done.progress);
    EXPECT_LE(done.lit.front().frames, done.progress.acknowledged);
  }
}

TEST_F(RecorderTrouble, GoesOnWithADeviceThatComesBack) {
  const auto device = open_device("sim:rig?leds=2&seconds=8&fast&unplug_at=2&unplug_for=3").value();
  const auto done = record(*device, {}, {.rate_hz = 100.0});
  EXPECT_EQ(done.end, RecorderEnd::complete);
  EXPECT_EQ(done.progress.reopened, 1);
  EXPECT_EQ(done.progress.frames, 800);
  EXPECT_EQ(done.progress.acknowledged, 800 - done.progress.dropped_by_device);
  EXPECT_GT(done.progress.dropped_by_device, 290);
  const auto read = io::read_counts(file_).value();
  EXPECT_EQ(read.counts.frames(), 800);
  EXPECT_EQ(value(read, "acquisition_end", "reopened"), "1");
}

TEST_F(RecorderTrouble, GivesUpADeviceThatStaysAwayAndKeepsWhatCame) {
  PlayedDevice device;
  device.play = [](PlayedDevice& d, Block& block) -> Result<ReadResult> {
    if (d.next >= 50) return fail(Code::device, "played: is gone; look at its plug");
    return d.give(block, 10);
  };
  device.come_back = [](PlayedDevice&) { return fail(Code::device, "still gone"); };
  const auto done = record(device, {.give_up_s = 0.01, .look_every = milliseconds(1)});
  EXPECT_EQ(done.end, RecorderEnd::failed);
  EXPECT_EQ(done.error->code, Code::device);
  EXPECT_THAT(done.error->message, HasSubstr("look at its plug"));
  const auto read = io::read_counts(file_).value();
  EXPECT_EQ(read.counts.frames(), 50);
  EXPECT_EQ(read.end, io::RecordingEnd::closed);
  EXPECT_EQ(value(read, "acquisition_end", "ended"), "failed");
}

/// 50 frames, then a line that stays open and says nothing, until it was looked for twice and is back.
struct Silence {
  explicit Silence(double rate_hz = 100.0, double speed = 1.0) : device(speed) {
    device.rate_hz = rate_hz;
    device.play = [this](PlayedDevice& d, Block& block) -> Result<ReadResult> {
      if (d.next >= 100) return ReadResult::ended;
      if (d.next != 50 || tries == 2) return d.give(block, 10);
      clock->now += 100'000'000;
      if (++timeouts == 1000) d.next = 100;  // nobody tries
      return ReadResult::timeout;
    };
    device.come_back = [this](PlayedDevice& d) -> Status {
      if (++tries == 1) return fail(Code::device, "played: no rig answers");
      d.next = 70;
      return {};
    };
  }
  std::shared_ptr<HandClock> clock = std::make_shared<HandClock>();
  PlayedDevice device;
  int timeouts = 0, tries = 0;
};

TEST_F(RecorderTrouble, SeeksADeviceThatFellSilentOnAnOpenLine) {
  Silence silence;
  const auto done = record(silence.device, {.clock = silence.clock});
  EXPECT_EQ(done.end, RecorderEnd::complete);
  EXPECT_EQ(silence.timeouts, 21);  // of 100 ms
  EXPECT_EQ(silence.tries, 2);
  EXPECT_EQ(done.progress.reopened, 1);
  EXPECT_FALSE(done.progress.away);
  EXPECT_EQ(done.progress.dropped_by_device, 20);
  expect_adds_up(done.progress);
  EXPECT_EQ(value(io::read_counts(file_).value(), "gap", "frames"), "20");
}

TEST_F(RecorderTrouble, WaitsThreeFramesOfASlowDevice) {
  Silence silence(0.5);
  EXPECT_EQ(record(silence.device, {.clock = silence.clock}).progress.reopened, 1);
  EXPECT_EQ(silence.timeouts, 61);
}

TEST_F(RecorderTrouble, LetsADeviceBeSilentThatMay) {
  Silence paused, without_clock(100.0, 0.0), waits_for_trigger;
  paused.device.pauses();
  waits_for_trigger.device.next = 50;
  for (auto* one : {&paused, &without_clock, &waits_for_trigger}) {
    const auto done = record(one->device, {.recording = {.force = true}, .clock = one->clock});
    EXPECT_EQ(one->tries, 0);
    EXPECT_EQ(done.progress.reopened, 0);
  }
}

TEST_F(RecorderTrouble, GivesUpADeviceThatIsFoundAgainAndStaysSilent) {
  Silence silence;
  silence.device.come_back = [](PlayedDevice&) { return Status(); };
  const auto done = record(silence.device, {.give_up_s = 5.0, .clock = silence.clock});
  EXPECT_EQ(done.end, RecorderEnd::failed);
  ASSERT_TRUE(done.error);
  EXPECT_THAT(done.error->message, HasSubstr("played: gives no frames any more"));
  EXPECT_EQ(done.progress.acknowledged, 50);
}

TEST_F(RecorderTrouble, AnyOtherFailureEndsItAtOnce) {
  PlayedDevice device;
  device.play = [](PlayedDevice&, Block&) -> Result<ReadResult> { return fail(Code::io, "no disk"); };
  const auto done = record(device);
  EXPECT_EQ(done.error->message, "no disk");
  EXPECT_EQ(done.progress.frames, 0);
}

}  // namespace
}  // namespace kinemark::pipeline
