// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One pass of the judge over recordings into which known damage was put.
#include "kinemark/stages/motion/internal/sample_judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kJudgedFrames = 100;
constexpr double kWhiteNoise_m = 0.5e-3;

class SampleJudge : public ::testing::Test {
 protected:
  SampleJudge()
      : body(model::Model::compile(testing_body::description()).value()),
        markers(testing_body::record(body, kJudgedFrames, kWhiteNoise_m, 3)) {}

  /// Judged from `sound` to `last`, every frame solved with all its samples.
  [[nodiscard]] std::vector<Outlier> judge(std::int64_t sound, std::int64_t last) {
    const Problem problem = make_problem(body, markers, options).value();
    SolvedFrames solved;
    EXPECT_TRUE(FrameWalk(problem, options, {}).run(markers, true, solved));
    StepScale scale(problem, solved);
    return judge_samples(problem, options, markers, solved, scale, sound, last);
  }
  [[nodiscard]] std::vector<Outlier> judge() { return judge(0, kJudgedFrames - 1); }

  void move(std::int64_t marker, std::int64_t first, std::int64_t last, const Vector3d& by) {
    for (std::int64_t f = first; f <= last; ++f) markers.x(f, marker) += by;
  }
  void exchange(std::int64_t one, std::int64_t other, std::int64_t first, std::int64_t last) {
    for (std::int64_t f = first; f <= last; ++f) {
      const Vector3d x = markers.x(f, one);
      markers.x(f, one) = markers.x(f, other);
      markers.x(f, other) = x;
    }
  }

  IkOptions options;
  model::Model body;
  data::Trajectories markers;
};

TEST_F(SampleJudge, ASoundRecordingHasNoneInEitherDirection) {
  EXPECT_TRUE(judge(0, kJudgedFrames - 1).empty());
  EXPECT_TRUE(judge(kJudgedFrames - 1, 0).empty());
  EXPECT_TRUE(judge(50, 50).empty()) << "one frame, and it is believed";
}

TEST_F(SampleJudge, AStretchIsFoundFromBothSidesAsLongAsItIs) {
  move(6, 40, 46, {0.05, 0.06, -0.05});
  for (const auto& found : {judge(0, kJudgedFrames - 1), judge(kJudgedFrames - 1, 0)}) {
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].marker, 6);
    EXPECT_EQ(found[0].first_frame, 40);
    EXPECT_EQ(found[0].last_frame, 46);
    EXPECT_TRUE(found[0].returned);
    EXPECT_EQ(found[0].partner, -1);
    EXPECT_GT(found[0].distance, 14.0);
    EXPECT_NEAR(found[0].length_m, Vector3d(0.05, 0.06, -0.05).norm(), 0.01);
    EXPECT_NEAR(found[0].from_model_m, found[0].length_m, 0.01);
    EXPECT_LT(found[0].expected_from_model_m, 0.01);
    EXPECT_TRUE(found[0].clearly_wrong());
  }
}

TEST_F(SampleJudge, OnlyTheFramesAskedForAreJudged) {
  move(6, 40, 42, {0.09, 0.0, 0.0});
  EXPECT_TRUE(judge(0, 39).empty());
  EXPECT_TRUE(judge(44, kJudgedFrames - 1).empty()) << "43 was sound, so is the speed that led to 44";
  EXPECT_TRUE(judge(60, 43).empty());
  const auto cut = judge(20, 41);
  ASSERT_EQ(cut.size(), 1U);
  EXPECT_EQ(cut[0].last_frame, 41);
  EXPECT_FALSE(cut[0].returned) << "nobody saw it come back";
}

TEST_F(SampleJudge, AMarkerThatLeaptBackNeedNotComeAsNearAsOneThatCrept) {
  // Another marker is wrong all the while, so that the frame as a whole does not speak for this one.
  move(12, 40, 50, {0.1, 0.1, 0.1});
  // Behind it lies some millimetres beside where it was: a sample that was good before would be taken there.
  move(2, 41, kJudgedFrames - 1, {0.0, 0.006, 0.0});
  const Vector3d there = markers.x(40, 2);
  const auto last_frame_of_the_marker = [&](const Vector3d& by) {
    markers.x(40, 2) = there + by;
    const auto found = judge();
    EXPECT_EQ(found.size(), 2U);
    return found.front().marker == 2 ? found.front().last_frame : found.back().last_frame;
  };
  EXPECT_EQ(last_frame_of_the_marker({0.3, 0.4, -0.3}), 40);
  EXPECT_GT(last_frame_of_the_marker({0.0, 0.02, 0.0}), 41);
}

TEST_F(SampleJudge, SeveralMarkersAtOnceAreEachNamed) {
  const std::set<std::int64_t> spoilt{1, 4, 9, 12};
  for (const std::int64_t m : spoilt) move(m, 30, 31, Vector3d(0.1, -0.06, 0.05) * (m % 2 ? 1.0 : -1.0));
  std::set<std::int64_t> named;
  for (const Outlier& o : judge()) {
    named.insert(o.marker);
    EXPECT_EQ(o.first_frame, 30);
    EXPECT_EQ(o.last_frame, 31);
  }
  EXPECT_EQ(named, spoilt);
}

TEST_F(SampleJudge, ExchangedMarkersNameEachOther) {
  exchange(4, 6, 50, 59);
  const auto found = judge();
  ASSERT_EQ(found.size(), 2U);
  for (const Outlier& o : found) {
    EXPECT_EQ(o.partner, o.marker == 4 ? 6 : 4);
    EXPECT_EQ(o.first_frame, 50);
    EXPECT_EQ(o.last_frame, 59);
    EXPECT_TRUE(o.returned);
  }
  EXPECT_NE(found[0].marker, found[1].marker);
}

TEST_F(SampleJudge, AnExchangeBeforeTheSoundFrameIsRecognisedByTheModel) {
  // Believed from frame 0 on, though exchanged: when they change back, the model says which side was right.
  exchange(4, 6, 0, 49);
  const auto found = judge();
  ASSERT_EQ(found.size(), 2U);
  for (const Outlier& o : found) {
    EXPECT_EQ(o.partner, o.marker == 4 ? 6 : 4);
    EXPECT_EQ(o.first_frame, 0);
    EXPECT_EQ(o.last_frame, 49);
  }
}

TEST_F(SampleJudge, AGapIsNotHeldAgainstTheMarker) {
  for (std::int64_t f = 30; f < 60; ++f)
    for (const std::int64_t m : {3, 8, 9}) markers.set_missing(f, m);
  EXPECT_TRUE(judge().empty());
  for (std::int64_t f = 70; f < 75; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) markers.set_missing(f, m);
  EXPECT_TRUE(judge().empty()) << "nor frames in which nothing is seen";
}

TEST_F(SampleJudge, ASampleBehindAGapIsJudgedByWhatWasThereBefore) {
  for (std::int64_t f = 30; f < 36; ++f) markers.set_missing(f, 8);
  move(8, 36, 38, {0.0, 0.15, 0.1});
  const auto found = judge();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].marker, 8);
  EXPECT_EQ(found[0].first_frame, 36);
  EXPECT_EQ(found[0].last_frame, 38);
}

/// The forearm's only marker is away while the elbow moves.
class OnlyMarker : public SampleJudge {
 protected:
  static constexpr std::int64_t kOnly = 7, kOther = 6, kFrames = 240;
  static constexpr int kOnlyOfThoseSeen = 6;

  void away(std::int64_t first, std::int64_t frames) {
    markers = testing_body::record(body, kFrames, kWhiteNoise_m, 3);
    for (std::int64_t f = 0; f < kFrames; ++f) markers.set_missing(f, kOther);
    for (std::int64_t f = first; f < first + frames; ++f) markers.set_missing(f, kOnly);
  }
};

TEST_F(OnlyMarker, IsBelievedWhereItsSegmentMayHaveGoneWhileItWasAway) {
  for (const std::int64_t first : {30, 77, 110})
    for (const std::int64_t frames : {1, 4, 10, 25, 50, 100}) {
      away(first, frames);
      EXPECT_TRUE(judge(0, kFrames - 1).empty()) << first << ' ' << frames;
      EXPECT_TRUE(judge(kFrames - 1, 0).empty()) << first << ' ' << frames;
    }
}

TEST_F(OnlyMarker, IsBelievedThoughAnotherSampleOfThatFrameIsWrong) {
  for (const std::int64_t frames : {10, 50, 100}) {
    away(77, frames);
    markers.x(77 + frames, 0) += Vector3d(0.1, -0.1, 0.1);
    const auto found = judge(0, kFrames - 1);
    ASSERT_EQ(found.size(), 1U) << frames;
    EXPECT_EQ(found[0].marker, 0);
    EXPECT_EQ(found[0].first_frame, 77 + frames);
    EXPECT_EQ(found[0].last_frame, 77 + frames);
  }
}

TEST_F(OnlyMarker, IsNotBelievedWhereItsSegmentCannotHaveGone) {
  for (const std::int64_t frames : {10, 50, 100})
    for (const auto& wrong : std::initializer_list<std::function<Vector3d(std::int64_t)>>{
             [&](auto f) { return Vector3d(markers.x(f, kOnly) + Vector3d(0.3, 0.0, 0.0)); },
             [&](auto f) { return Vector3d(markers.x(f, kOnly) + Vector3d(0.0, 0.3, 0.0)); },
             [&](auto f) { return Vector3d(markers.x(f, kOnly) + Vector3d(0.0, 0.0, -0.3)); },
             [&](auto) { return Vector3d(0.0, 0.0, 0.0); },
             [&](auto f) { return Vector3d(markers.x(f, 11)); },
             [&](auto f) { return Vector3d(markers.x(f, 2)); }}) {
      away(77, frames);
      const std::int64_t back = 77 + frames;
      markers.x(back, kOnly) = wrong(back);
      const auto found = judge(0, kFrames - 1);
      ASSERT_EQ(found.size(), 1U) << frames;
      EXPECT_EQ(found[0].marker, kOnlyOfThoseSeen);
      EXPECT_EQ(found[0].first_frame, back);
      EXPECT_EQ(found[0].last_frame, back);
    }
}

TEST_F(SampleJudge, TheBodyMayBeThrownAsAWhole) {
  for (std::int64_t f = 50; f < kJudgedFrames; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) markers.x(f, m) += Vector3d(0.02, 0.03, 0.01);
  EXPECT_TRUE(judge().empty());
}

TEST_F(SampleJudge, ItDoesNotMatterWhereTheLaboratoryIs) {
  move(6, 40, 46, {0.05, 0.06, -0.05});
  const auto here = judge();
  const Eigen::AngleAxisd turn(0.8, Vector3d(0.1, 0.9, 0.3).normalized());
  for (std::int64_t f = 0; f < kJudgedFrames; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      markers.x(f, m) = (turn * Vector3d(markers.x(f, m)) + Vector3d(2.0, -1.0, 0.5)).eval();
  const auto there = judge();
  ASSERT_EQ(there.size(), here.size());
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_EQ(there[i].marker, here[i].marker);
    EXPECT_EQ(there[i].first_frame, here[i].first_frame);
    EXPECT_EQ(there[i].last_frame, here[i].last_frame);
    EXPECT_NEAR(there[i].length_m, here[i].length_m, 2e-3);
  }
}

TEST(Outlier, IsClearlyWrongOnlyWhenMuchFartherThanExpectedByBothMeasures) {
  const auto wrong = [](double from, double expected) {
    return Outlier{.from_model_m = from, .expected_from_model_m = expected}.clearly_wrong();
  };
  EXPECT_TRUE(wrong(0.05, 0.0));
  EXPECT_FALSE(wrong(0.009, 0.0)) << "a centimetre is little";
  EXPECT_FALSE(wrong(0.13, 0.1)) << "half as much again is little";
  EXPECT_TRUE(wrong(0.16, 0.1));
  EXPECT_FALSE(wrong(0.0, 0.1)) << "it came nearer";
}

}  // namespace
}  // namespace kinemark::motion::internal
