// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/recorder.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <csignal>
#include <fstream>
#include <functional>
#include <mutex>
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

/// A clock that a test moves on.
class HandClock final : public stream::HostClock {
 public:
  [[nodiscard]] std::int64_t now_ns() const override { return now; }
  void sleep_until(std::int64_t time_ns) override { now = std::max<std::int64_t>(now, time_ns); }
  std::atomic<std::int64_t> now = 1;
};

/// A device that does what the test says; it has one LED and one camera.
class PlayedDevice final : public stream::Device {
 public:
  explicit PlayedDevice(double speed = 0.0) { capabilities_.speed = speed; }
  std::function<Result<ReadResult>(PlayedDevice&, Block&)> play;
  std::function<Status(PlayedDevice&)> come_back = [](PlayedDevice&) { return Status(); };
  std::int64_t next = 0;
  double rate_hz = 100.0;
  Status starts, ends;
  void pauses() { capabilities_.pauses = true; }

  [[nodiscard]] const stream::DeviceCapabilities& capabilities() const override { return capabilities_; }
  [[nodiscard]] Result<stream::GrantedPlan> configure(const stream::ScanPlan& plan) override {
    return stream::GrantedPlan{.plan = plan,
                               .layout = data::Counts::zeros({"hand"}, {"A"}, {.rate_hz = rate_hz}, false),
                               .facts = {}};
  }
  [[nodiscard]] Status start() override { return starts; }
  [[nodiscard]] Result<ReadResult> read(Block& block, milliseconds) override { return play(*this, block); }
  [[nodiscard]] Status stop() override { return ++stops, ends; }
  [[nodiscard]] Status reopen() override { return come_back(*this); }
  [[nodiscard]] Status write_analog(int, double) override { return {}; }
  [[nodiscard]] Status write_digital(int, bool) override { return {}; }
  int stops = 0;

  ReadResult give(Block& block, std::int64_t frames) {
    block.first_frame = next;
    block.frames = frames;
    block.counts.clear();
    for (; next < block.first_frame + frames; ++next)
      for (int k = 0; k < 4; ++k) block.counts.push_back(static_cast<std::int16_t>(next % 4000));
    block.flags.assign(static_cast<std::size_t>(frames), 0);
    block.host_after_ns = next * 10'000'000;
    return ReadResult::block;
  }

 private:
  stream::DeviceCapabilities capabilities_{.name = "played", .most_leds = 1, .cameras = 1};
};

class Recording : public testing::Test {
 protected:
  testing_support::ScratchFolder scratch_;
  std::filesystem::path file_ = scratch_ / "trial.mcap";

  Recorded record(stream::Device& device, RecorderOptions options = {}, const stream::ScanPlan& plan = {}) {
    if (options.file.empty()) options.file = file_;
    const auto granted = device.configure(plan).value();
    return Recorder::start(device, granted, std::move(options)).value()->finish();
  }
  static void expect_adds_up(const RecorderProgress& p) {
    EXPECT_EQ(p.frames, p.received + p.dropped_by_device);
    EXPECT_EQ(p.received, p.acknowledged + p.dropped_here);
  }
  static std::string value(const io::CountsRecording& read, const char* name, const char* key) {
    for (const auto& one : read.metadata)
      if (one.name == name) return one.values.at(key);
    return "absent";
  }
};

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

TEST_F(Recording, CountsWhatTheDeviceDidNotGive) {
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
TEST_F(Recording, CountsWhatTheDiskWasTooSlowForInThreads) {
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

TEST_F(Recording, CountsWhatAFullDiskDidNotTakeInThreads) {
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

TEST_F(Recording, GoesOnWithADeviceThatComesBack) {
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

TEST_F(Recording, GivesUpADeviceThatStaysAwayAndKeepsWhatCame) {
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

TEST_F(Recording, SeeksADeviceThatFellSilentOnAnOpenLine) {
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

TEST_F(Recording, WaitsThreeFramesOfASlowDevice) {
  Silence silence(0.5);
  EXPECT_EQ(record(silence.device, {.clock = silence.clock}).progress.reopened, 1);
  EXPECT_EQ(silence.timeouts, 61);
}

TEST_F(Recording, LetsADeviceBeSilentThatMay) {
  Silence paused, without_clock(100.0, 0.0), waits_for_trigger;
  paused.device.pauses();
  waits_for_trigger.device.next = 50;
  for (auto* one : {&paused, &without_clock, &waits_for_trigger}) {
    const auto done = record(one->device, {.recording = {.force = true}, .clock = one->clock});
    EXPECT_EQ(one->tries, 0);
    EXPECT_EQ(done.progress.reopened, 0);
  }
}

TEST_F(Recording, GivesUpADeviceThatIsFoundAgainAndStaysSilent) {
  Silence silence;
  silence.device.come_back = [](PlayedDevice&) { return Status(); };
  const auto done = record(silence.device, {.give_up_s = 5.0, .clock = silence.clock});
  EXPECT_EQ(done.end, RecorderEnd::failed);
  ASSERT_TRUE(done.error);
  EXPECT_THAT(done.error->message, HasSubstr("played: gives no frames any more"));
  EXPECT_EQ(done.progress.acknowledged, 50);
}

TEST_F(Recording, AnyOtherFailureEndsItAtOnce) {
  PlayedDevice device;
  device.play = [](PlayedDevice&, Block&) -> Result<ReadResult> { return fail(Code::io, "no disk"); };
  const auto done = record(device);
  EXPECT_EQ(done.error->message, "no disk");
  EXPECT_EQ(done.progress.frames, 0);
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
