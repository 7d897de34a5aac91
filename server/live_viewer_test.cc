// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/live_viewer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <limits>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "server/testing/fake_clock.h"
#include "server/testing/push_bytes.h"

namespace kinemark::server {
namespace {

/// A value of a message, on a machine with the little end first.
template <class T>
T at(const std::string& message, std::size_t offset) {
  T value{};
  std::memcpy(&value, message.data() + offset, sizeof(T));
  return value;
}

TEST(LiveMessage, AFrameOfMarkersByteByByte) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> x{1.5, -2.0, 0.25, nan, nan, nan};
  const std::vector<data::SampleState> state{data::SampleState::measured, data::SampleState::rejected};
  const auto message = markers_message(7, 0.5, 12.25, x, state);
  ASSERT_EQ(message.size(), kLiveHeadBytes + 6 * 4 + 2);
  EXPECT_EQ(message[0], 1);
  EXPECT_EQ(message[1], 1);
  EXPECT_EQ(at<std::uint16_t>(message, 2), 2);
  EXPECT_EQ(at<std::uint32_t>(message, 4), 0U);
  EXPECT_EQ(at<double>(message, 8), 7.0);
  EXPECT_EQ(at<double>(message, 16), 0.5);
  EXPECT_EQ(at<double>(message, 24), 12.25);
  EXPECT_TRUE(std::isnan(at<float>(message, 32)));
  EXPECT_EQ(at<float>(message, 40), 1.5F);
  EXPECT_EQ(at<float>(message, 44), -2.0F);
  EXPECT_TRUE(std::isnan(at<float>(message, 52)));
  EXPECT_EQ(message[64], 1);
  EXPECT_EQ(message[65], 5);
}

motion::LivePose two_coordinates() {
  motion::LivePose pose{.frame = 3, .time_s = 0.1, .determined = {1, 0}};
  pose.q = Eigen::Vector2d(0.25, 0.02);
  pose.q_sd = Eigen::Vector2d(0.5, kNaN);
  return pose;
}

TEST(LiveMessage, AFrameOfAnglesByteByByte) {
  const auto message = angles_message(two_coordinates(), std::vector{8.0, 1000.0}, 4.0);
  ASSERT_EQ(message.size(), kLiveHeadBytes + 2 * 9);
  EXPECT_EQ(message[0], 2);
  EXPECT_EQ(at<double>(message, 8), 3.0);
  EXPECT_EQ(at<double>(message, 16), 0.1);
  EXPECT_EQ(at<double>(message, 24), 4.0);
  EXPECT_EQ(at<float>(message, 40), 2.0F);
  EXPECT_EQ(at<float>(message, 44), 20.0F);
  EXPECT_EQ(at<float>(message, 48), 4.0F);
  EXPECT_TRUE(std::isnan(at<float>(message, 52)));
  EXPECT_EQ(message[56], 1);
  EXPECT_EQ(message[57], 0);
  EXPECT_THROW((void)angles_message(two_coordinates(), std::vector{8.0}, 4.0), ContractError);
}

TEST(LiveMessage, PosesOfBodiesGoalsAndAPushFollowTheAngles) {
  auto pose = two_coordinates();
  pose.goal = Eigen::Matrix3Xd::Constant(3, 2, 0.5);
  pose.goal.col(1).setConstant(kNaN);
  const std::vector<double> body_poses{1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.25};
  auto message = angles_message(pose, std::vector{8.0, 1000.0}, 4.0, body_poses);
  const std::size_t at_poses = kLiveHeadBytes + 2 * 9;
  ASSERT_EQ(message.size(), at_poses + 4 * (7 + 6 + 1));
  EXPECT_EQ(at<std::uint16_t>(message, 36), 1) << "bodies";
  EXPECT_EQ(at<std::uint16_t>(message, 38), 2) << "goals";
  EXPECT_EQ(at<float>(message, at_poses + 8), 3.0F);
  EXPECT_EQ(at<float>(message, at_poses + 24), 0.25F);
  EXPECT_EQ(at<float>(message, at_poses + 28), 0.5F);
  EXPECT_TRUE(std::isnan(at<float>(message, at_poses + 40)));
  EXPECT_TRUE(std::isnan(at<float>(message, at_poses + 52))) << "nobody pushes";
  pose.pushed_q = pose.q;
  pose.pushed_m = 0.015;
  message = angles_message(pose, std::vector{8.0, 1000.0}, 4.0, body_poses);
  EXPECT_EQ(at<float>(message, at_poses + 52), 15.0F) << "mm";
  EXPECT_EQ(at<float>(message, 40), 2.0F) << "angles stay those of the tracked body";
  EXPECT_EQ(at<std::uint32_t>(angles_message(pose, std::vector{8.0, 1000.0}, 4.0), 36), 0U);
}

TEST(LiveMessage, AnglesAreInDegreesAndTranslationsInMillimetres) {
  const auto model = model::Model::compile(pipeline::human_model().value()).value();
  const auto units = message_units(model);
  const auto& coordinates = model.description().coordinates;
  ASSERT_EQ(units.size(), coordinates.size());
  std::size_t rotations = 0;
  for (std::size_t c = 0; c < units.size(); ++c) {
    EXPECT_EQ(units[c], coordinates[c].is_rotation ? kDegPerRad : 1000.0) << coordinates[c].name;
    rotations += coordinates[c].is_rotation;
  }
  EXPECT_EQ(rotations, units.size() - 3) << "the root moves in three directions";
}

TEST(LiveMessage, ASentenceIsCutWhereItsCountEnds) {
  const auto message = sentence_message("the disk is full", 1.0);
  EXPECT_EQ(message[0], 3);
  EXPECT_EQ(message.substr(kLiveHeadBytes), "the disk is full");
  EXPECT_EQ(sentence_message(std::string(70'000, 'x'), 1.0).size(), kLiveHeadBytes + 65'535);
}

TEST(LiveMessage, WhatDiffersBetweenViewersIsSetAlone) {
  auto message = sentence_message("x", 1.0);
  const auto before = message;
  set_viewer_fields(message, 0x01020304, 0.25F);
  EXPECT_EQ(at<std::uint32_t>(message, 4), 0x01020304U);
  EXPECT_EQ(at<float>(message, 32), 0.25F);
  message.replace(4, 4, before, 4, 4);
  message.replace(32, 4, before, 32, 4);
  EXPECT_EQ(message, before);
}

TEST(LiveMessage, ACountIsAWholeNumberOfEightBytes) {
  const auto bytes = [](double value) {
    std::string text(8, '\0');
    std::memcpy(text.data(), &value, 8);
    return text;
  };
  EXPECT_EQ(drawn_count(bytes(0.0)), 0U);
  EXPECT_EQ(drawn_count(bytes(12'345.0)), 12'345U);
  for (const double wrong : {-1.0, 0.5, 1e300, HUGE_VAL, std::nan("")})
    EXPECT_FALSE(drawn_count(bytes(wrong))) << wrong;
  EXPECT_FALSE(drawn_count(""));
  EXPECT_FALSE(drawn_count(bytes(1.0) + "x"));
}

std::string count_bytes(double count) {
  std::string text(8, '\0');
  std::memcpy(text.data(), &count, 8);
  return text;
}

double frame_of(const std::string& message) {
  double frame = 0.0;
  std::memcpy(&frame, message.data() + 8, 8);
  return frame;
}

std::uint32_t dropped_of(const std::string& message) {
  std::uint32_t dropped = 0;
  std::memcpy(&dropped, message.data() + 4, 4);
  return dropped;
}

float answer_of(const std::string& message) {
  float answer_s = 0.0F;
  std::memcpy(&answer_s, message.data() + 32, 4);
  return answer_s;
}

class LiveViewerTest : public ::testing::Test {
 protected:
  /// Frame f of no markers, due now.
  void offer(std::int64_t f, LiveKind kind = LiveKind::markers) {
    const double now_s = clock_->now_s();
    auto message = markers_message(f, 0.0, now_s, {}, {});
    message[0] = static_cast<char>(kind);
    viewer_.offer(std::make_shared<const std::string>(std::move(message)), kind, now_s);
  }
  /// All that it takes now: numbers of frames.
  std::vector<double> take() {
    std::vector<double> frames;
    while (const auto message = viewer_.next()) {
      viewer_.sent();
      frames.push_back(frame_of(*message));
      last_ = *message;
    }
    return frames;
  }

  std::shared_ptr<testing::FakeClock> clock_ = std::make_shared<testing::FakeClock>();
  LiveViewer viewer_{{.waiting = 3, .under_way = 4}, clock_};
  std::string last_;
};

TEST_F(LiveViewerTest, FramesComeInOrder) {
  EXPECT_EQ(viewer_.next(), nullptr);
  offer(0);
  offer(1);
  EXPECT_EQ(take(), (std::vector<double>{0, 1}));
  EXPECT_EQ(viewer_.state().sent, 2);
  EXPECT_EQ(viewer_.state().dropped, 0);
}

TEST_F(LiveViewerTest, WhoIsSlowLosesTheOldestAndIsSaidHowMany) {
  for (int f = 0; f < 10; ++f) offer(f);
  EXPECT_EQ(take(), (std::vector<double>{7, 8, 9}));
  EXPECT_EQ(dropped_of(last_), 7U);
  EXPECT_EQ(viewer_.state().dropped, 7);
}

TEST_F(LiveViewerTest, DropsAreCountedByKind) {
  offer(0);
  offer(0, LiveKind::angles);
  for (int f = 1; f < 4; ++f) offer(f);
  EXPECT_EQ(viewer_.state().dropped, 1);
  EXPECT_EQ(viewer_.state().dropped_angles, 0) << "frames of markers do not push angles out";
  for (int f = 1; f < 4; ++f) offer(f, LiveKind::angles);
  EXPECT_EQ(viewer_.state().dropped, 1) << "nor angles the newest markers";
  EXPECT_EQ(viewer_.state().dropped_angles, 1);
}

TEST_F(LiveViewerTest, WhatPeopleShouldKnowIsNotDropped) {
  offer(-1, LiveKind::sentence);
  for (int f = 0; f < 10; ++f) offer(f);
  EXPECT_EQ(take(), (std::vector<double>{-1, 7, 8, 9}));
}

TEST_F(LiveViewerTest, APushIsHeardWhereThereIsABody) {
  const auto wish = testing::push_bytes(1, Eigen::Vector3d::Zero(), {0.0, 50.0, 0.0});
  EXPECT_FALSE(viewer_.heard(wish)) << "no body";
  const auto push = std::make_shared<LivePush>(2);
  LiveViewer pushing({.waiting = 3, .under_way = 4}, clock_, push);
  EXPECT_TRUE(pushing.heard(wish));
  EXPECT_EQ(push->now(clock_->now_s())->force_in_world.y(), 50.0);
  EXPECT_FALSE(pushing.heard(testing::push_bytes(2, Eigen::Vector3d::Zero(), {0.0, 50.0, 0.0})));
  EXPECT_EQ(pushing.next(), nullptr) << "nothing to say";
  pushing.closed();
  EXPECT_FALSE(push->now(clock_->now_s())) << "its page was closed";
}

TEST_F(LiveViewerTest, WhoIsRefusedOftenHearsItOnceAtATime) {
  const auto push = std::make_shared<LivePush>(2);
  LiveViewer pushing({.waiting = 3, .under_way = 4}, clock_, push);
  for (int i = 0; i < 100; ++i)
    EXPECT_TRUE(pushing.heard(testing::push_bytes(1, Eigen::Vector3d::Zero(), {0.0, 600.0, 0.0})));
  const auto said = pushing.next();
  ASSERT_NE(said, nullptr);
  EXPECT_EQ(said->substr(kLiveHeadBytes), "the body is pushed by at most 500 N; 600 N were not applied");
  EXPECT_EQ(pushing.next(), nullptr);
  EXPECT_FALSE(push->now(clock_->now_s()));
}

TEST_F(LiveViewerTest, NoMoreIsUnderWayThanWasAgreed) {
  for (int f = 0; f < 3; ++f) offer(f);
  (void)take();
  for (int f = 3; f < 6; ++f) offer(f);
  EXPECT_EQ(take(), (std::vector<double>{3})) << "four are under way";
  EXPECT_TRUE(viewer_.heard(count_bytes(2)));
  EXPECT_EQ(take(), (std::vector<double>{4, 5}));
  EXPECT_EQ(viewer_.state().dropped, 0);
}

TEST_F(LiveViewerTest, WhoDrawsLateGetsNothingAheadOfThat) {
  offer(0);
  (void)take();
  clock_->pass(0.31);
  offer(1);
  EXPECT_EQ(viewer_.next(), nullptr) << "frame 0 is not drawn for long";
  for (int f = 2; f < 6; ++f) offer(f);
  EXPECT_TRUE(viewer_.heard(count_bytes(1)));
  EXPECT_EQ(take(), (std::vector<double>{3, 4, 5})) << "the newest, not those that were there first";
  EXPECT_EQ(viewer_.state().dropped, 2);
}

/// A viewer that takes `per_second` messages of 480 that come in a second; the oldest that it drew, s, after
/// the first two seconds.
double oldest_drawn(testing::FakeClock& clock, LiveViewer& viewer, double per_second) {
  std::deque<double> in_network;  // when they were due
  double oldest = 0.0, credit = 0.0;
  std::uint64_t drawn = 0;
  const double start_s = clock.now_s();
  for (int f = 0; f < 10 * 480; ++f) {
    clock.pass(1.0 / 480.0);
    const double now_s = clock.now_s();
    const auto kind = f % 2 == 0 ? LiveKind::markers : LiveKind::angles;
    auto message = markers_message(f, 0.0, now_s, {}, {});
    message[0] = static_cast<char>(kind);
    viewer.offer(std::make_shared<const std::string>(std::move(message)), kind, now_s);
    while (const auto next = viewer.next()) {
      viewer.sent();
      in_network.push_back(start_s + (frame_of(*next) + 1.0) / 480.0);
    }
    for (credit += per_second / 480.0; credit >= 1.0 && !in_network.empty(); credit -= 1.0) {
      if (now_s - start_s > 2.0) oldest = std::max(oldest, now_s - in_network.front());
      in_network.pop_front();
      EXPECT_TRUE(viewer.heard(count_bytes(static_cast<double>(++drawn))));
    }
    credit = std::min(credit, 1.0);
  }
  return oldest;
}

TEST(LiveViewerPace, WhatASlowViewerDrawsIsNeverOldHoweverSlowItIs) {
  for (const double per_second : {30.0, 60.0, 120.0}) {
    const auto clock = std::make_shared<testing::FakeClock>();
    LiveViewer viewer({}, clock);
    EXPECT_LT(oldest_drawn(*clock, viewer, per_second), 0.6) << per_second;
    EXPECT_GT(viewer.state().dropped, 0);
  }
}

TEST(LiveViewerPace, WhoTakesAllGetsAll) {
  const auto clock = std::make_shared<testing::FakeClock>();
  LiveViewer viewer({}, clock);
  EXPECT_LT(oldest_drawn(*clock, viewer, 500.0), 0.02);
  EXPECT_EQ(viewer.state().dropped + viewer.state().dropped_angles, 0);
}

TEST_F(LiveViewerTest, WhoDrawsMoreGetsMoreAtATime) {
  const auto clock = std::make_shared<testing::FakeClock>();
  LiveViewer viewer({.waiting = 100}, clock);
  const auto offer_all = [&] {
    for (int f = 0; f < 100; ++f)
      viewer.offer(std::make_shared<const std::string>(markers_message(f, 0.0, 0.0, {}, {})),
                   LiveKind::markers, 0.0);
  };
  const auto given = [&] {
    std::size_t count = 0;
    while (viewer.next()) ++count;
    return count;
  };
  offer_all();
  EXPECT_EQ(given(), 4U);
  EXPECT_TRUE(viewer.heard(count_bytes(4)));
  EXPECT_EQ(given(), 9U) << "four were drawn, and five more may be under way";
  EXPECT_TRUE(viewer.heard(count_bytes(13)));
  clock->pass(0.31);
  EXPECT_EQ(given(), 4U) << "what was drawn long ago does not count";
}

TEST_F(LiveViewerTest, AnglesThatComeLateByDesignAreNoDelay) {
  offer(0, LiveKind::angles);
  clock_->pass(0.25);
  (void)take();
  EXPECT_TRUE(viewer_.heard(count_bytes(1)));
  EXPECT_EQ(viewer_.state().longest_ms, 0.0);
  offer(1);
  clock_->pass(0.125);
  (void)take();
  EXPECT_TRUE(std::isnan(answer_of(last_)));
  EXPECT_EQ(viewer_.state().longest_ms, 125.0);
}

TEST_F(LiveViewerTest, HowLongItTookUntilDrawnStandsInTheNextMessage) {
  offer(0);
  (void)take();
  EXPECT_TRUE(std::isnan(answer_of(last_)));
  clock_->pass(0.25);
  EXPECT_TRUE(viewer_.heard(count_bytes(1)));
  offer(1);
  (void)take();
  EXPECT_EQ(answer_of(last_), 0.25F);
}

TEST_F(LiveViewerTest, WhatCannotHaveBeenDrawnIsNotUnderstood) {
  offer(0);
  offer(1);
  (void)take();
  EXPECT_FALSE(viewer_.heard(count_bytes(3)));
  EXPECT_FALSE(viewer_.heard("nonsense but 8"));
  EXPECT_TRUE(viewer_.heard(count_bytes(2)));
  EXPECT_TRUE(viewer_.heard(count_bytes(2))) << "nothing new";
  EXPECT_FALSE(viewer_.heard(count_bytes(1))) << "less than before";
}

TEST_F(LiveViewerTest, EndsWhenAllIsDrawn) {
  offer(0);
  viewer_.finish("the source has ended after 1 frame");
  viewer_.finish("and again");
  offer(1);
  EXPECT_FALSE(viewer_.end());
  EXPECT_EQ(take(), (std::vector<double>{0})) << "nothing comes after the end";
  EXPECT_FALSE(viewer_.end()) << "it is not drawn yet";
  EXPECT_TRUE(viewer_.heard(count_bytes(1)));
  ASSERT_TRUE(viewer_.end());
  EXPECT_EQ(viewer_.end()->code, 1000);
  EXPECT_EQ(viewer_.end()->reason, "the source has ended after 1 frame");
}

TEST_F(LiveViewerTest, AReasonFitsIntoACloseFrame) {
  viewer_.finish(std::string(500, 'x'));
  EXPECT_EQ(viewer_.end()->reason.size(), 120U);
}

TEST_F(LiveViewerTest, IsWokenForEachMessageUntilItIsGone) {
  int woken = 0;
  viewer_.opened([&woken] { ++woken; });
  offer(0);
  offer(1);
  EXPECT_EQ(woken, 2);
  viewer_.closed();
  EXPECT_TRUE(viewer_.gone());
  offer(2);
  EXPECT_EQ(woken, 2);
  EXPECT_EQ(viewer_.next(), nullptr);
}

TEST(Durations, SharesAreFoundToAStep) {
  Durations durations;
  EXPECT_EQ(durations.share_ms(0.99), 0.0);
  for (int i = 1; i <= 100; ++i) durations.add(1e-3 * i / 10.0);  // 0.1 to 10 ms
  EXPECT_NEAR(durations.share_ms(0.5), 5.0, 0.1);
  EXPECT_NEAR(durations.share_ms(0.99), 9.9, 0.1);
  EXPECT_NEAR(durations.longest_ms(), 10.0, 1e-9);
  EXPECT_GE(durations.share_ms(0.99), 9.9 - 1e-9) << "never less than it was";
}

TEST(Durations, WhatIsLongerThanTheyReachIsTheLongest) {
  Durations durations;
  durations.add(3.0);
  durations.add(-1.0);
  EXPECT_EQ(durations.count(), 2);
  EXPECT_NEAR(durations.share_ms(1.0), 3000.0, 1e-9);
}

}  // namespace

}  // namespace kinemark::server
