// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Recordings judged in both directions of time.
#include "kinemark/stages/motion/internal/judgement.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <string>

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
  [[nodiscard]] std::int64_t sound_frame() const {
    SolvedFrames solved;
    const Problem problem = solve(solved);
    for (std::int64_t f = 0; f < kRecordedFrames; ++f) solved.cost[static_cast<std::size_t>(f)] = cost(f);
    return find_sound_frame(problem, markers, solved);
  }

  IkOptions options;
  model::Model body;
  data::Trajectories markers;
  /// What each frame is said to cost: those about frame 50 the least.
  std::function<double(std::int64_t)> cost = [](std::int64_t f) {
    return 1e-4 * (1.0 + static_cast<double>(std::abs(f - 50)));
  };
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

TEST_F(RecordingJudgement, BeginsInTheCheapestFrames) {
  EXPECT_EQ(sound_frame(), 50);
  const auto usual = cost;
  cost = [&](std::int64_t f) { return f == 50 ? 1.0 : usual(f); };
  EXPECT_EQ(sound_frame(), 47) << "one dear frame among the five is too many";
}

TEST_F(RecordingJudgement, DoesNotBeginWhereAMarkerComesAndGoes) {
  for (const bool only_in_part_of_it : {true, false}) {
    // Of 24 markers one less is nearly all.
    auto description = testing_body::description();
    for (int i = 0; i < 10; ++i) {
      auto marker = description.markers[2];
      marker.name += std::to_string(i);
      description.markers.push_back(marker);
    }
    body = model::Model::compile(description).value();
    markers = testing_body::record(body, kRecordedFrames, 0.5e-3, 3);
    for (std::int64_t f = 0; f < kRecordedFrames; ++f)
      if (f == 49 || (!only_in_part_of_it && f % 2 == 1)) markers.set_missing(f, 7);
    EXPECT_EQ(sound_frame(), only_in_part_of_it ? 52 : 50) << "where they always do, it must begin somewhere";
  }
}

TEST_F(RecordingJudgement, DoesNotBeginWhereSamplesWereLeftOut) {
  for (std::int64_t f = 40; f < 60; ++f) markers.set_missing(f, 7, data::SampleState::rejected);
  EXPECT_TRUE(sound_frame() == 37 || sound_frame() == 62)
      << sound_frame() << ": the cheapest ones lack a sample";
  for (std::int64_t f = 0; f < kRecordedFrames; ++f) markers.set_missing(f, 7, data::SampleState::rejected);
  EXPECT_EQ(sound_frame(), 50) << "where all do, it must begin somewhere";
}

TEST_F(RecordingJudgement, JudgesWhereMarkersComeAndGoInEveryFrame) {
  for (std::int64_t f = 0; f < kRecordedFrames; ++f) markers.set_missing(f, f % markers.markers());
  markers.x(57, 4) += Vector3d(0.1, 0.1, 0.0);
  ASSERT_TRUE(markers.present(57, 4));
  const auto found = judge();
  ASSERT_EQ(found.bad.size(), 1U);
  EXPECT_EQ(found.bad[0].first_frame, 57);
}

}  // namespace
}  // namespace kinemark::motion::internal
