// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Recordings judged in both directions of time, and samples that give themselves away without a model.
#include "kinemark/stages/motion/internal/judgement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kRecordedFrames = 100;

class RecordingJudgement : public ::testing::Test {
 protected:
  RecordingJudgement()
      : body(model::Model::compile(testing_body::description()).value()),
        markers(testing_body::record(body, kRecordedFrames, 0.5e-3, 3)) {}

  [[nodiscard]] Problem solve(SolvedFrames& solved) const {
    Problem problem = make_problem(body, markers, options).value();
    EXPECT_TRUE(FrameWalk(problem, options, {}).run(markers, true, solved));
    return problem;
  }
  [[nodiscard]] Judgement judge() const {
    SolvedFrames solved;
    const Problem problem = solve(solved);
    return judge_recording(problem, options, markers, solved);
  }
  [[nodiscard]] std::vector<Outlier> plain_defects() const {
    SolvedFrames solved;
    const Problem problem = solve(solved);
    return find_plain_defects(problem, markers, solved);
  }
  void hold(std::int64_t marker, std::int64_t first, std::int64_t last) {
    for (std::int64_t f = first + 1; f <= last; ++f) markers.x(f, marker) = markers.x(first, marker);
  }
  /// Every marker goes on as between frames 30 and 31, by so much of that step a frame.
  void slow_down(double share) {
    const auto fast = markers;
    for (std::int64_t f = 0; f < kRecordedFrames; ++f)
      for (std::int64_t m = 0; m < markers.markers(); ++m)
        markers.x(f, m) = fast.x(30, m) + (fast.x(31, m) - fast.x(30, m)) * share * static_cast<double>(f);
  }
  void keep_digits(double digit_m) {
    for (std::int64_t f = 0; f < kRecordedFrames; ++f)
      for (std::int64_t m = 0; m < markers.markers(); ++m)
        for (double& value : markers.x(f, m)) value = digit_m * std::round(value / digit_m);
  }

  IkOptions options;
  model::Model body;
  data::Trajectories markers;
};

TEST_F(RecordingJudgement, WhatOneSideAloneSaysOfAnEndMustBeSure) {
  for (const std::int64_t frame : {std::int64_t{0}, kRecordedFrames - 1}) {
    const Vector3d before = markers.x(frame, 6);
    markers.x(frame, 6) += Vector3d(0.0, 0.013, 0.0);
    const auto doubt = judge();
    EXPECT_TRUE(doubt.bad.empty());
    ASSERT_EQ(doubt.doubtful.size(), 1U) << "kept, and said";
    EXPECT_EQ(doubt.doubtful[0].marker, 6);
    EXPECT_EQ(doubt.doubtful[0].first_frame, frame);
    EXPECT_LT(doubt.doubtful[0].distance, 20.0);
    markers.x(frame, 6) = before + Vector3d(0.0, 0.03, 0.0);
    const auto sure = judge();
    EXPECT_TRUE(sure.doubtful.empty());
    ASSERT_EQ(sure.bad.size(), 1U);
    EXPECT_EQ(sure.bad[0].marker, 6);
    EXPECT_GT(sure.bad[0].distance, 20.0);
    markers.x(frame, 6) = before;
  }
}

TEST_F(RecordingJudgement, BothSidesOfTheSameSampleNeedNotBeSoSure) {
  markers.x(50, 6) += Vector3d(0.0, 0.013, 0.0);
  const auto found = judge();
  EXPECT_TRUE(found.doubtful.empty());
  ASSERT_EQ(found.bad.size(), 1U);
  EXPECT_EQ(found.bad[0].first_frame, 50);
  EXPECT_LT(found.bad[0].distance, 20.0);
}

TEST_F(RecordingJudgement, DoesNotBeginWhereAMarkerComesAndGoes) {
  // A marker that the model does not fit holds the forearm away from where it is; without it the pose leaps.
  for (std::int64_t f = 0; f < kRecordedFrames; ++f) markers.x(f, 7) += Vector3d(0.1, 0.1, 0.0);
  // The frames beside the gap are the cheapest of all.
  const auto exact = testing_body::record(body, kRecordedFrames);
  for (std::int64_t f = 48; f <= 52; ++f) {
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      if (m != 7) markers.x(f, m) = exact.x(f, m);
  }
  markers.set_missing(49, 7);
  const auto found = judge();
  EXPECT_TRUE(found.bad.empty());
  EXPECT_TRUE(found.doubtful.empty());
}

TEST_F(RecordingJudgement, JudgesWhereMarkersComeAndGoInEveryFrame) {
  for (std::int64_t f = 0; f < kRecordedFrames; ++f) markers.set_missing(f, f % markers.markers());
  markers.x(57, 4) += Vector3d(0.1, 0.1, 0.0);
  ASSERT_TRUE(markers.present(57, 4));
  const auto found = judge();
  ASSERT_EQ(found.bad.size(), 1U);
  EXPECT_EQ(found.bad[0].first_frame, 57);
}

TEST_F(RecordingJudgement, AValueHeldWhileTheBodyHardlyMovesIsFound) {
  slow_down(0.05);
  ASSERT_LT((markers.x(47, 7) - markers.x(40, 7)).norm(), 2e-3);
  hold(7, 40, 47);
  const auto found = plain_defects();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].why, Outlier::Why::held);
  EXPECT_EQ(found[0].first_frame, 41);
  EXPECT_EQ(found[0].last_frame, 47);
}

TEST_F(RecordingJudgement, ACoarseRecordingRepeatsItselfWithoutBeingHeld) {
  // Whole millimetres, a slow movement: values repeat for many frames.
  slow_down(0.02);
  keep_digits(1e-3);
  std::int64_t repeats = 0;
  for (std::int64_t f = 2; f < kRecordedFrames; ++f)
    repeats += markers.x(f, 7) == markers.x(f - 1, 7) && markers.x(f, 7) == markers.x(f - 2, 7);
  ASSERT_GT(repeats, 0);
  EXPECT_TRUE(plain_defects().empty());
}

}  // namespace
}  // namespace kinemark::motion::internal
