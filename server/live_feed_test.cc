// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Frames from a source to recording, model and viewers, by a clock that never waits.
#include "server/live_feed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>
#include <vector>

#include "kinemark/io/recording/mcap_markers.h"
#include "kinemark/pipeline/live/live_input.h"
#include "kinemark/stream/recorded_source.h"
#include "kinemark/workflow/live/live.h"
#include "server/testing/fake_clock.h"
#include "support/scratch.h"

namespace kinemark::server {
namespace {

FrameQueue::FramePtr frame_of(std::int64_t number) {
  auto out = std::make_shared<stream::Frame>();
  out->number = number;
  return out;
}

/// Notes what it gets, and fails from frame `fails_at` on.
class Noting final : public stream::Sink {
 public:
  Noting(std::vector<std::int64_t>& got, std::int64_t fails_at) : got_(got), fails_at_(fails_at) {}
  Status push(const stream::Frame& frame) override {
    if (frame.number >= fails_at_) return fail(Code::io, "full");
    got_.push_back(frame.number);
    return {};
  }
  Status finish() override {
    got_.push_back(-1);
    return {};
  }

 private:
  std::vector<std::int64_t>& got_;
  std::int64_t fails_at_;
};

TEST(FrameQueue, GivesInOrderAndCountsWhatItDrops) {
  FrameQueue queue(2);
  for (int f = 0; f < 5; ++f) queue.push(frame_of(f));
  EXPECT_EQ(queue.dropped(), 3);
  queue.finish();
  EXPECT_EQ(queue.pop()->number, 3);
  EXPECT_EQ(queue.pop()->number, 4);
  EXPECT_EQ(queue.pop(), nullptr);
  FrameQueue all(0);
  for (int f = 0; f < 5000; ++f) all.push(frame_of(f));
  EXPECT_EQ(all.dropped(), 0);
  EXPECT_EQ(all.pop()->number, 0);
}

TEST(SinkThread, TakesAllThatCameBeforeItsEnd) {
  std::vector<std::int64_t> got;
  SinkThread sink(std::make_unique<Noting>(got, 100), 0, [](const Error&) { ADD_FAILURE(); });
  for (int f = 0; f < 50; ++f) sink.push(frame_of(f));
  sink.finish();
  sink.join();
  ASSERT_EQ(got.size(), 51U);
  EXPECT_EQ(got[49], 49);
  EXPECT_EQ(got[50], -1) << "its end";
}

TEST(SinkThread, AFailureIsSaidOnceAndEndsIt) {
  std::vector<std::int64_t> got;
  std::vector<std::string> said;
  {
    SinkThread sink(std::make_unique<Noting>(got, 2), 0,
                    [&said](const Error& e) { said.push_back(e.message); });
    for (int f = 0; f < 5; ++f) sink.push(frame_of(f));
  }
  EXPECT_EQ(got, (std::vector<std::int64_t>{0, 1}));
  EXPECT_EQ(said, std::vector<std::string>{"full"});
}

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Markers "A" and "B"; A moves by 1 mm a frame, B is missing in each third frame.
data::Trajectories markers_of(std::int64_t frames) {
  auto out = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 240.0, .t0_s = 0.0, .frames = frames});
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      if (m == 1 && f % 3 == 2) continue;
      out.x(f, m) = Eigen::Vector3d(1e-3 * static_cast<double>(f), static_cast<double>(m), 1.0);
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

std::unique_ptr<stream::Source> source_of(std::int64_t frames) {
  return std::make_unique<stream::RecordedSource>(markers_of(frames), stream::SourceFacts{.name = "test"});
}

/// A device that breaks after three frames, and never knew how many there would be.
class Breaking final : public stream::Source {
 public:
  Breaking() : Source({.name = "device", .markers = {"A"}, .rate_hz = 100.0}) {}
  Result<bool> next(stream::Frame& frame) override {
    if (came_ == 3) return fail(Code::io, "device: the cable is out");
    frame.number = came_++;
    frame.clear(1);
    return true;
  }

 private:
  std::int64_t came_ = 0;
};

class LiveFeedThread : public ::testing::Test {
 protected:
  [[nodiscard]] LiveFeedOptions options(std::unique_ptr<stream::Source> source) {
    return {.source = std::move(source), .clock = clock_, .say = [this](std::string_view line) {
              const std::scoped_lock lock(mutex_);
              said_.emplace_back(line);
            }};
  }

  std::shared_ptr<testing::FakeClock> clock_ = std::make_shared<testing::FakeClock>();
  std::mutex mutex_;
  std::vector<std::string> said_;
  testing_support::ScratchFolder scratch_;
};

TEST_F(LiveFeedThread, EveryFrameIsRecordedAsItIs) {
  auto given = options(source_of(3000));
  given.record = scratch_ / "live.mcap";
  const auto expected = markers_of(3000);
  const auto feed = LiveFeed::create(std::move(given)).value();
  feed->start();
  feed->wait();
  EXPECT_EQ(feed->state().frames, 3000);
  EXPECT_EQ(feed->state().recorded, 3000);
  EXPECT_TRUE(feed->state().ended);
  const auto trial = io::read_mcap_markers(scratch_ / "live.mcap").value();
  EXPECT_THAT(trial.warnings, IsEmpty());
  ASSERT_EQ(trial.markers.names, expected.names);
  ASSERT_EQ(trial.markers.frames(), 3000);
  EXPECT_EQ(trial.markers.time.rate_hz, 240.0);
  EXPECT_EQ(trial.markers.state, expected.state);
  for (std::int64_t f = 0; f < 3000; ++f) {
    EXPECT_EQ(trial.markers.x(f, 0), expected.x(f, 0));
    EXPECT_EQ(trial.markers.present(f, 1), f % 3 != 2);
  }
  EXPECT_THAT(said_, ElementsAre(HasSubstr("the source has ended after 3000 frames; 3000 recorded in ")));
}

TEST_F(LiveFeedThread, AViewerThatTakesNothingHoldsNobodyBack) {
  auto given = options(source_of(1000));
  given.limits = {.waiting = 10, .under_way = 5, .at_first = 5};
  const auto feed = LiveFeed::create(std::move(given)).value();
  const auto idle = feed->add_viewer();
  feed->start();
  feed->wait();
  EXPECT_EQ(feed->state().frames, 1000);
  EXPECT_EQ(idle->state().dropped, 990);
  std::int64_t taken = 0;
  while (idle->next() != nullptr) ++taken;
  EXPECT_EQ(taken, 5) << "no more are under way";
}

TEST_F(LiveFeedThread, AnglesAreThoseOfTheFramesGivenOneAtATime) {
  constexpr const char* kWalk =
      "sim:walk?rate=100&seconds=0.4";  // no frame waits for longer than the patience
  auto input = pipeline::open_live_input(kWalk).value();
  auto given = options(std::move(input.source));
  given.model = input.model;
  given.limits = {.waiting = 1000, .under_way = 1000, .at_first = 1000};
  const auto feed = LiveFeed::create(std::move(given)).value();
  const auto viewer = feed->add_viewer();
  feed->start();
  feed->wait();
  EXPECT_EQ(feed->state().unsolved, 0);
  std::vector<std::string> seen;
  while (const auto message = viewer->next())
    if (message->front() == static_cast<char>(LiveKind::angles))
      seen.push_back(message->substr(kLiveHeadBytes));
  std::vector<std::string> expected;
  const auto again = pipeline::open_live_input(kWalk).value();
  const auto units = message_units(*again.model);
  BodyPoses body_poses(again.model);
  const auto angles =
      workflow::live(*again.model, again.source->facts(), [&](const auto& pose) {
        expected.push_back(angles_message(pose, units, 0.0, body_poses.find(pose)).substr(kLiveHeadBytes));
      }).value();
  for (stream::Frame frame; again.source->next(frame).value();) ASSERT_TRUE(angles->push(frame));
  ASSERT_TRUE(angles->finish());
  EXPECT_EQ(expected.size(), 40U);
  EXPECT_EQ(seen, expected);
}

TEST_F(LiveFeedThread, ThoseThatComeLateHearThatItHasEnded) {
  const auto feed = LiveFeed::create(options(source_of(5))).value();
  feed->start();
  feed->wait();
  const auto late = feed->add_viewer();
  EXPECT_EQ(late->next(), nullptr);
  ASSERT_TRUE(late->end());
  EXPECT_EQ(late->end()->reason, "the source has ended after 5 frames");
}

TEST_F(LiveFeedThread, ViewersAreNotWithoutNumber) {
  auto given = options(source_of(5));
  given.most_viewers = 2;
  const auto feed = LiveFeed::create(std::move(given)).value();
  const auto first = feed->add_viewer();
  auto second = feed->add_viewer();
  EXPECT_NE(second, nullptr);
  EXPECT_EQ(feed->add_viewer(), nullptr);
  second.reset();
  const auto third = feed->add_viewer();
  EXPECT_NE(third, nullptr) << "the place of one that went";
  first->closed();
  EXPECT_NE(feed->add_viewer(), nullptr);
}

TEST_F(LiveFeedThread, ARecordingThatIsThereStays) {
  const auto recording = [this](bool force) {
    auto given = options(source_of(5));
    given.record = scratch_ / "live.mcap";
    given.force = force;
    return LiveFeed::create(std::move(given));
  };
  EXPECT_TRUE(recording(false));
  const auto second = recording(false);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Code::io);
  EXPECT_TRUE(recording(true));
}

TEST_F(LiveFeedThread, ASourceThatFailsEndsWithItsReasonAndWhatHasCome) {
  auto given = options(std::make_unique<Breaking>());
  given.record = scratch_ / "live.mcap";
  const auto feed = LiveFeed::create(std::move(given)).value();
  EXPECT_EQ(feed->state().of_frames, std::nullopt);
  feed->start();
  feed->wait();
  EXPECT_TRUE(feed->state().ended);
  EXPECT_THAT(
      said_,
      ElementsAre(HasSubstr("the source has failed after 3 frames: device: the cable is out; 3 recorded")));
  EXPECT_EQ(io::read_mcap_markers(scratch_ / "live.mcap").value().markers.frames(), 3);
}

TEST_F(LiveFeedThread, EndsInTheMiddleWithWhatHasCome) {
  auto given = options(source_of(100'000));
  given.record = scratch_ / "live.mcap";
  auto feed = LiveFeed::create(std::move(given)).value();
  const auto viewer = feed->add_viewer();
  feed->start();
  while (feed->state().recorded == 0) std::this_thread::yield();
  feed.reset();
  const auto trial = io::read_mcap_markers(scratch_ / "live.mcap").value();
  EXPECT_THAT(trial.warnings, IsEmpty()) << "it was closed";
  EXPECT_GT(trial.markers.frames(), 0);
  double taken = 0.0;
  while (viewer->next() != nullptr) ++taken;
  EXPECT_FALSE(viewer->end()) << "it has not drawn what came";
  for (double before = 0.0; taken > before;) {
    before = taken;
    EXPECT_TRUE(viewer->heard({reinterpret_cast<const char*>(&taken), sizeof(taken)}));
    while (viewer->next() != nullptr) ++taken;
  }
  EXPECT_TRUE(viewer->end());
}

TEST_F(LiveFeedThread, TheSteadyClockWakesWhenItIsStopped) {
  SteadyClock clock;
  EXPECT_TRUE(clock.sleep_until(clock.now_s()));
  std::thread sleeper([&clock] { EXPECT_FALSE(clock.sleep_until(clock.now_s() + 1e6)); });
  clock.stop();
  sleeper.join();
}

}  // namespace

}  // namespace kinemark::server
