// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What is said of a recording of walking: each sentence where it is so, and none of them of a clean walk.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "kinemark/stages/analysis/gait/gait_events.h"
#include "kinemark/stages/analysis/gait/marker_events.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::KnownWalk;
using ::testing::Not;

class GaitFindings : public ::testing::Test {
 protected:
  explicit GaitFindings(data::Trajectories markers = KnownWalk{}.markers(0.0003, 3))
      : markers_(std::move(markers)) {}

  std::vector<std::string> tell() {
    const auto which = find_gait_markers(markers_).value();
    auto smoother = GaitSmoother::create(markers_, which, 0.0).value();
    auto found = find_marker_events(smoother, which).value();
    if (change_) change_(found);
    return findings_of(smoother, found);
  }

  data::Trajectories markers_;
  std::function<void(MarkerEvents&)> change_;
};

TEST_F(GaitFindings, NothingIsSaidOfACleanWalk) {
  const auto said = tell();
  EXPECT_THAT(said, Not(Contains(HasSubstr("no plates have judged events of going"))));
  EXPECT_THAT(said, Not(Contains(HasSubstr("foot: a marker is held still, "))));
  EXPECT_THAT(said, Not(Contains(HasSubstr(" there and back and "))));
  EXPECT_THAT(said, Not(Contains(HasSubstr(", events there cannot be found"))));
  EXPECT_THAT(said, Not(Contains(HasSubstr("% of the frames, gaps of up to 0.25 s are bridged"))));
  EXPECT_THAT(said, Not(Contains(HasSubstr("foot: no strike is found"))));
  EXPECT_THAT(said, Not(Contains(HasSubstr("foot: strides of very different duration, "))));
  EXPECT_THAT(said, Not(Contains(HasSubstr("strikes of the left foot beside "))));
  EXPECT_THAT(said, Not(Contains(HasSubstr("front of the pelvis"))));
}

TEST_F(GaitFindings, HeldAndHiddenAndLeapingMarkers) {
  for (std::int64_t f = 121; f < 300; ++f)
    for (const std::int64_t m : {2, 3}) markers_.x(f, m) = Eigen::Vector3d(markers_.x(120, m));
  for (std::int64_t f = 40; f < 600; f += 150) markers_.x(f, 0).x() += 0.3;
  const auto said = tell();
  EXPECT_THAT(said, Contains(HasSubstr("right foot: a marker is held still, from 1.21 to 2.99 s")));
  EXPECT_THAT(said, Contains(HasSubstr(", events there cannot be found")));
  EXPECT_THAT(said, Contains(HasSubstr(" there and back and are left out")));
}

TEST_F(GaitFindings, ShortGapsAreCounted) {
  for (std::int64_t f = 20; f < 600; f += 60)
    for (std::int64_t k = f; k < f + 12; ++k) markers_.set_missing(k, 0);
  EXPECT_THAT(tell(), Contains(HasSubstr("left foot: seen in 80 % of the frames, gaps of up to 0.25 s are "
                                         "bridged")));
}

TEST_F(GaitFindings, BackwardEventsHaveNeverBeenJudged) {
  const auto walk = markers_;
  for (std::int64_t f = 0; f < walk.frames(); ++f)
    for (std::int64_t m = 0; m < walk.markers(); ++m)
      markers_.x(f, m) = Eigen::Vector3d(walk.x(walk.frames() - 1 - f, m));
  EXPECT_THAT(tell(), Contains(HasSubstr("no plates have judged events of going backward: their SDs are 1.5 "
                                         "times those of going forward")));
}

TEST_F(GaitFindings, StrikesThatAreMissingOrUneven) {
  change_ = [](MarkerEvents& found) {
    std::erase_if(found.events, [](const data::GaitEvent& e) {
      return e.side == Side::right && e.what == FootEvent::strike;
    });
  };
  EXPECT_THAT(tell(), Contains("right foot: no strike is found"));
  EXPECT_THAT(tell(), Contains(HasSubstr("strikes of the left foot beside 0 of the right one")));
  change_ = [](MarkerEvents& found) {
    double later = 0.0;
    for (auto& e : found.events)
      if (e.side == Side::left && e.what == FootEvent::strike) e.time_s += (later = 3.0 * later + 0.1);
  };
  EXPECT_THAT(tell(), Contains(HasSubstr("left foot: strides of very different duration, ")));
}

TEST_F(GaitFindings, RunnersSidesAreThoseOfThePelvis) {
  change_ = [](MarkerEvents& found) {
    found.kind.manner = GaitManner::run;
    found.kind.left_of_right_m = -0.06;  // runners' feet cross
    found.kind.pelvis_left_of_right_m = -0.22;
  };
  EXPECT_THAT(tell(), Contains(HasSubstr("the left front of the pelvis lies 220 mm to the right of the right "
                                         "one")));
  change_ = [](MarkerEvents& found) {
    found.kind.left_of_right_m = -0.1;
    found.kind.ankles_outward_m = -0.04;
  };
  EXPECT_THAT(tell(), Contains(HasSubstr("the left foot lies 100 mm to the right of the right one")));
}

TEST(GaitKindSentences, AreThoseOfTheKind) {
  GaitKind kind{.speed_m_per_s = 1.3, .stride_s = 1.1};
  EXPECT_THAT(kind.sentence(), HasSubstr(": 1.30 m/s, strides of 1.10 s"));
  EXPECT_THAT(kind.sentence(), Not(HasSubstr("no stride seen whole")));
  EXPECT_THAT(kind.sentence(), Not(HasSubstr(": each lasts more than ")));
  kind.longer_than_s = 0.0;
  EXPECT_THAT(kind.sentence(), HasSubstr(": 1.30 m/s, no stride seen whole"));
  kind.longer_than_s = 0.62;
  EXPECT_THAT(kind.sentence(), HasSubstr(": 1.30 m/s, no stride seen whole: each lasts more than 0.62 s"));
  EXPECT_THAT(kind.sentence(), Not(HasSubstr("strides of")));
  kind.direction = GaitDirection::forward;
  EXPECT_THAT(kind.sentence(), Not(HasSubstr("; the feet slide back at ")));
  EXPECT_THAT(kind.sentence(), Not(HasSubstr("; forward or backward is not known, as no foot's heel")));
  kind.belt = true;
  kind.belt_m_per_s = 1.25;
  EXPECT_THAT(kind.sentence(), HasSubstr("; the feet slide back at 1.250 m/s while they stand"));
}

// Why a recording is none of gait: of a walk, its first stride, jumps and feet under a body that stays.
TEST(GaitKindSentences, SayWhyThereIsNoGait) {
  const auto why = [](const data::Trajectories& markers) {
    const auto which = find_gait_markers(markers).value();
    auto smoother = GaitSmoother::create(markers, which, 0.0).value();
    return find_marker_events(smoother, which).value().kind.not_gait;
  };
  const auto walk = KnownWalk{}.markers(0.0003, 3);
  EXPECT_THAT(why(walk), Not(HasSubstr("no foot swings: none moves by 80 mm over the ground")));
  EXPECT_THAT(why(walk), Not(HasSubstr("the feet move, but the body goes ")));
  EXPECT_THAT(why(walk), Not(HasSubstr("the feet land and leave ")));
  EXPECT_THAT(why(walk), Not(HasSubstr("both feet land together, as in a jump")));
  auto steps = walk;  // one step, then somebody stands for five seconds
  for (std::int64_t f = 40; f < walk.frames(); ++f)
    for (std::int64_t m = 0; m < walk.markers(); ++m)
      steps.x(f, m) = Eigen::Vector3d(walk.x(40, m)) + 1e-3 * (walk.x(f, m) - walk.x(40, m));
  EXPECT_THAT(why(steps), Not(::testing::IsEmpty()));
  auto exercise = walk;  // one foot goes to and fro under a body that stays
  for (std::int64_t f = 0; f < walk.frames(); ++f) {
    const double to_and_fro = 0.3 * std::sin(2.0 * std::numbers::pi * walk.time.time_s(f));
    for (std::int64_t m = 0; m < 4; ++m)
      exercise.x(f, m) =
          Eigen::Vector3d((m < 2 ? to_and_fro : 0.0) + (m % 2 == 1 ? 0.2 : 0.0), m < 2 ? 0.1 : -0.1, 0.05);
    exercise.x(f, 4) = Eigen::Vector3d(0.0, 0.0, 0.95 + 1e-4 * to_and_fro);
  }
  EXPECT_THAT(why(exercise), HasSubstr("the feet move, but the body goes "));
}

TEST(GaitFindingsOfFiles, EventsInTurnWithinTheRecordingSayNothing) {
  const TimeBase five{.rate_hz = 100.0, .frames = 501};
  const std::vector<data::Event> in_turn{{"LHS", "", 1.0}, {"LTO", "", 1.6}, {"LHS", "", 2.1}};
  const auto found = events_of_file(in_turn, five);
  EXPECT_THAT(found.notes, Not(Contains(HasSubstr("the file's event "))));
  EXPECT_THAT(found.notes, Not(Contains(HasSubstr(" lies outside the recording, "))));
  EXPECT_THAT(found.notes, Not(Contains(HasSubstr(" follows another of its kind, with no "))));
  EXPECT_THAT(found.notes, Not(Contains(HasSubstr(" is labelled between "))));
}

}  // namespace
}  // namespace kinemark::analysis
