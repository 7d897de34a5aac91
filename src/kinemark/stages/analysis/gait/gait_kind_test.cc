// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_kind.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "kinemark/stages/analysis/gait/marker_events.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using ::testing::HasSubstr;
using testing::KnownWalk;
using ::testing::Not;

MarkerEvents judged(const data::Trajectories& markers) {
  const auto which = find_gait_markers(markers).value();
  auto smoother = GaitSmoother::create(markers, which, 0.0).value();
  return find_marker_events(smoother, which).value();
}

// Somebody who springs: stances of 36 % and a pelvis that is lowest in the middle of them.
data::Trajectories running(double speed_m_per_s, bool treadmill, double stride_s = 0.7) {
  KnownWalk run;
  run.speed_m_per_s = speed_m_per_s, run.stride_s = stride_s, run.stance = {0.36, 0.36},
  run.treadmill = treadmill;
  run.rate_hz = 200.0;
  auto out = run.markers(0.0003, 4);
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    const double share = (out.time.time_s(f) - run.first_strike_s) / run.stride_s - 0.18;
    out.x(f, 4).z() = 0.95 - 0.04 * std::cos(4.0 * std::numbers::pi * share);
  }
  return out;
}

TEST(GaitKind, WalkingIsForwardOverGroundOrOnABelt) {
  for (const bool treadmill : {false, true}) {
    KnownWalk walk;
    walk.treadmill = treadmill;
    const auto kind = judged(walk.markers(0.0003, 3)).kind;
    EXPECT_EQ(kind.not_gait, "");
    EXPECT_EQ(kind.manner, GaitManner::walk);
    EXPECT_EQ(kind.belt, treadmill);
    EXPECT_EQ(kind.direction, GaitDirection::forward);
    EXPECT_FALSE(kind.turning || kind.brief);
    EXPECT_NEAR(kind.speed_m_per_s, 1.3, 0.02);
    EXPECT_NEAR(kind.left_of_right_m, 0.1, 0.03);
    EXPECT_EQ(kind.flight_share, 0.0);
    EXPECT_GT(kind.bounce_m, 0.01);
    EXPECT_NE(
        kind.sentence().find(treadmill ? "walking on a treadmill, forward" : "walking over ground, forward"),
        std::string::npos);
  }
}

TEST(GaitKind, TheSameReversedInTimeIsBackward) {
  const auto walk = KnownWalk{}.markers(0.0003, 3);
  auto back = walk;
  for (std::int64_t f = 0; f < walk.frames(); ++f)
    for (std::int64_t m = 0; m < walk.markers(); ++m) back.x(f, m) = walk.x(walk.frames() - 1 - f, m);
  const auto found = judged(back);
  EXPECT_EQ(found.kind.direction, GaitDirection::backward);
  EXPECT_EQ(found.kind.manner, GaitManner::walk);
  EXPECT_FALSE(found.kind.belt);
  EXPECT_NEAR(found.kind.speed_m_per_s, 1.3, 0.02);
  // What events of a kind have in common is 1.5 times as uncertain as where the detectors agree, beside what
  // they usually lie apart by.
  for (const auto what : data::kFootEvents) {
    const auto event = std::ranges::find(found.events, what, &data::GaitEvent::what);
    const auto& fused = found.fused[static_cast<std::size_t>(event - found.events.begin())];
    const double agreed_s =
        1.5 * fuse({kNaN, kNaN, kNaN, 0.0}, what, false, FootSet::heel_and_toe, 0.01).error.kind_s;
    EXPECT_GE(fused.error.kind_s, agreed_s);
    EXPECT_GE(fused.error.own_s, 1.5 * 0.007);
  }
}

TEST(GaitKind, FlightAndASpringAreARunAndAboveSixMetresASecondASprint) {
  const auto run = judged(running(3.2, false)).kind, belt = judged(running(3.2, true)).kind,
             sprint = judged(running(6.8, false, 0.5)).kind;
  EXPECT_EQ(run.manner, GaitManner::run);
  EXPECT_FALSE(run.belt);
  EXPECT_EQ(belt.manner, GaitManner::run);
  EXPECT_TRUE(belt.belt);
  EXPECT_NEAR(belt.belt_m_per_s, 3.2, 0.1);
  EXPECT_EQ(sprint.manner, GaitManner::sprint);
  EXPECT_FALSE(sprint.belt);
  EXPECT_LT(run.bounce_m, 0.0);
  EXPECT_GT(run.flight_share, 0.1);
}

TEST(GaitKind, NeitherFlightNorASpringAloneIsARun) {
  EXPECT_FALSE((RunEvidence{.flight_share = 0.046, .bounce_m = 0.02, .stance_share = 0.6}.runs()));
  EXPECT_FALSE((RunEvidence{.flight_share = 0.0, .bounce_m = -0.05, .stance_share = 0.6}.runs()));
  EXPECT_TRUE((RunEvidence{.flight_share = 0.1, .bounce_m = -0.05, .stance_share = 0.6}.runs()));
  EXPECT_TRUE((RunEvidence{.flight_share = 0.1, .bounce_m = kNaN, .stance_share = 0.4}.runs()));
  EXPECT_FALSE((RunEvidence{.flight_share = 0.1, .bounce_m = kNaN, .stance_share = kNaN}.runs()));
  EXPECT_TRUE((
      RunEvidence{.flight_share = 0.1, .bounce_m = kNaN, .stance_share = 0.56, .speed_m_per_s = 2.7}.runs()));
  EXPECT_FALSE(
      (RunEvidence{.flight_share = 0.01, .bounce_m = kNaN, .stance_share = 0.56, .speed_m_per_s = 2.7}
           .runs()));
}

TEST(GaitKind, ACurveIsATurn) {
  const auto walk = KnownWalk{}.markers(0.0003, 3);
  auto curve = walk;
  for (std::int64_t f = 0; f < walk.frames(); ++f)
    for (std::int64_t m = 0; m < walk.markers(); ++m) {
      // The way along the heading becomes an arc of 4 m radius.
      const Eigen::Vector3d x = walk.x(f, m);
      const double along = std::cos(0.4) * x.x() + std::sin(0.4) * x.y(),
                   left = -std::sin(0.4) * x.x() + std::cos(0.4) * x.y(), a = along / 4.0;
      curve.x(f, m) = Eigen::Vector3d((4.0 - left) * std::sin(a), 4.0 - (4.0 - left) * std::cos(a), x.z());
    }
  const auto kind = judged(curve).kind;
  EXPECT_TRUE(kind.turning);
  EXPECT_EQ(kind.direction, GaitDirection::forward);
  EXPECT_NEAR(kind.turn_rad, 7.0 / 4.0, 0.5);
  EXPECT_FALSE(judged(walk).kind.turning);
}

TEST(GaitKind, WhatIsNoLocomotionIsSaidWhy) {
  auto stands = KnownWalk{}.markers(0.0003, 3);
  for (std::int64_t f = 1; f < stands.frames(); ++f)
    for (std::int64_t m = 0; m < stands.markers(); ++m)
      stands.x(f, m) = stands.x(0, m) + 1e-4 * (stands.x(f, m) - stands.x(0, m));
  EXPECT_NE(judged(stands).kind.not_gait.find("no foot swings"), std::string::npos);
  // Feet that go to and fro under a body that stays.
  auto exercise = KnownWalk{}.markers(0.0003, 3);
  for (std::int64_t f = 0; f < exercise.frames(); ++f) {
    const double t = exercise.time.time_s(f), s = 0.3 * std::sin(2.0 * std::numbers::pi * t);
    for (std::int64_t m = 0; m < 4; ++m)
      exercise.x(f, m) = Eigen::Vector3d(m < 2 ? s : 0.0, m < 2 ? 0.1 : -0.1, 0.05) +
                         Eigen::Vector3d(m % 2 == 1 ? 0.2 : 0.0, 0, 0);
    exercise.x(f, 4) = Eigen::Vector3d(0.0, 0.0, 0.95 + 1e-4 * s);
  }
  EXPECT_NE(judged(exercise).kind.not_gait.find("the body goes"), std::string::npos)
      << judged(exercise).kind.not_gait;
  // Both feet as one.
  const auto walk = KnownWalk{}.markers(0.0003, 3);
  auto jumps = walk;
  for (std::int64_t f = 0; f < walk.frames(); ++f)
    for (const std::int64_t m : {2, 3}) jumps.x(f, m) = walk.x(f, m - 2) + Eigen::Vector3d(0.05, -0.1, 0.0);
  EXPECT_EQ(judged(jumps).kind.not_gait, "both feet land together, as in a jump");
  // Strolls of which little is seen: some of them show a step or two.
  bool few = false;
  for (const double stride : {1.6, 2.2, 3.0})
    for (const double duration : {1.0, 1.5, 2.2}) {
      KnownWalk stroll;
      stroll.speed_m_per_s = 0.35, stroll.stride_s = stride, stroll.duration_s = duration;
      const auto brief = stroll.markers(0.0003, 3);
      const auto which = find_gait_markers(brief).value();
      auto smoother = GaitSmoother::create(brief, which, 0.0);
      if (!smoother) continue;
      const auto events = find_marker_events(*smoother, which);
      if (!events) continue;
      few = few || events->kind.not_gait == "the feet land and leave 2 times in all; need 3" ||
            events->kind.not_gait == "the feet land and leave 1 times in all; need 3";
    }
  EXPECT_TRUE(few);
}

TEST(GaitKind, ABeltIsOneFloor) {
  KnownWalk walk;
  walk.treadmill = true;
  const auto on_belt = walk.markers(0.0003, 3);
  EXPECT_EQ(judged(on_belt).kind.not_gait, "");
  EXPECT_TRUE(judged(on_belt).kind.belt);
  auto swings = on_belt;  // somebody who hangs, and moves the legs as in a walk
  for (std::int64_t f = 0; f < swings.frames(); ++f)
    for (std::int64_t m = 0; m < swings.markers(); ++m)
      swings.x(f, m).z() += 0.12 * std::sin(2.0 * std::numbers::pi * 0.23 * swings.time.time_s(f));
  EXPECT_THAT(judged(swings).kind.not_gait, HasSubstr("but stand in heights that differ by"));
  for (const double rise_m : {0.02, 0.1}) {  // the belt's front goes up while somebody walks: 0.2 m in all
    auto rising = on_belt;
    for (std::int64_t f = 0; f < rising.frames(); ++f)
      for (std::int64_t m = 0; m < rising.markers(); ++m)
        rising.x(f, m).z() += rise_m < 0.05 ? rise_m * rising.time.time_s(f) : f > 300 ? rise_m : 0.0;
    EXPECT_EQ(judged(rising).kind.not_gait, "") << rise_m;
  }
  const auto noisy = judged(walk.markers(0.01, 3)).kind;  // 10 mm of noise are no other floor
  EXPECT_EQ(noisy.not_gait, "");
  EXPECT_THAT(noisy.not_gait, Not(HasSubstr("but stand in heights that differ by")));
  EXPECT_TRUE(noisy.belt);
}

TEST(GaitKind, WithoutHeelsAndPelvisTheDirectionIsNotSaid) {
  auto markers = KnownWalk{}.markers(0.0003, 3);
  markers.names = {"X1", "LTOE", "X2", "RTOE", "SACR"};
  const auto kind = judged(markers).kind;
  EXPECT_EQ(kind.direction, GaitDirection::unknown);
  EXPECT_THAT(kind.sentence(), HasSubstr("forward or backward is not known, as no foot's heel and toe"));
  EXPECT_THAT(judged(KnownWalk{}.markers(0.0003, 3)).kind.sentence(),
              Not(HasSubstr("forward or backward is not known, as no foot's heel and toe")));
}

TEST(GaitKind, HasNames) {
  EXPECT_EQ(to_string(GaitManner::sprint), "sprint");
  EXPECT_EQ(to_string(GaitDirection::sideways), "sideways");
}

// Somebody slow: stances of 80 %, and a pelvis that goes with the feet, so that it stands most of the time.
data::Trajectories in_pulses(double stride_m, double stride_s, std::uint64_t seed) {
  KnownWalk walk;
  walk.stride_s = stride_s, walk.speed_m_per_s = stride_m / stride_s, walk.stance = {0.8, 0.8};
  walk.width_m = 0.18, walk.duration_s = 14.0;
  auto out = walk.markers(0.0003, seed);
  for (std::int64_t f = 0; f < out.frames(); ++f)
    for (int axis = 0; axis < 2; ++axis)
      out.x(f, 4)[axis] =
          0.25 * (out.x(f, 0)[axis] + out.x(f, 1)[axis] + out.x(f, 2)[axis] + out.x(f, 3)[axis]);
  return out;
}

// The median of its speed, times a stride, is half the way and less.
TEST(GaitKind, TheBodyGoesItsWayThoughItGoesInPulses) {
  std::uint64_t seed = 0;
  for (const double stride_s : {2.0, 3.0, 3.5})
    for (const double stride_m : {0.4, 0.5, 0.6}) {
      const auto kind = judged(in_pulses(stride_m, stride_s, ++seed)).kind;
      EXPECT_EQ(kind.not_gait, "") << stride_s << " " << stride_m;
      EXPECT_FALSE(kind.belt);
    }
  for (const double stride_s : {2.0, 3.0, 3.5})
    EXPECT_THAT(judged(in_pulses(0.25, stride_s, ++seed)).kind.not_gait,
                HasSubstr("the feet move, but the body goes 0.2"))
        << stride_s;
}

}  // namespace
}  // namespace kinemark::analysis
