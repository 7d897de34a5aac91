// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Streams into which known damage was put, judged frame by frame.
#include "kinemark/stages/motion/internal/stream_judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kFrames = 240;
constexpr double kRate_hz = 100.0;
constexpr std::int64_t kLearnt = 50;  // frames that are believed

class JudgedStream : public ::testing::Test {
 protected:
  JudgedStream()
      : body(model::Model::compile(testing_body::description()).value()),
        truth(testing_body::record(body, kFrames)),
        markers(testing_body::record(body, kFrames, 0.5e-3, 3)) {}

  using Sample = std::pair<std::int64_t, int>;  // frame and marker

  /// What was not believed; `used_m`: how far any sample that was used lay from the truth at most.
  std::set<Sample> judge() {
    const Problem problem = make_problem(body, markers, options).value();
    StreamJudge stream(problem, options, kRate_hz);
    std::set<Sample> out;
    const int M = problem.model.marker_count();
    Eigen::Matrix3Xd y(3, M);
    Eigen::VectorXd weight(M);
    used_m = 0.0;
    for (std::int64_t f = 0; f < kFrames; ++f) {
      problem.observe(markers, f, y, weight);
      stream.judge(y, weight);
      for (int m = 0; m < M; ++m) {
        if (stream.out()[static_cast<std::size_t>(m)] != 0) out.emplace(f, m);
        const int d = problem.data_marker[static_cast<std::size_t>(m)];
        if (weight[m] > 0.0) used_m = std::max(used_m, (y.col(m) - truth.x(f, d)).norm());
      }
    }
    return out;
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
  data::Trajectories truth, markers;
  double used_m = 0.0;
};

TEST_F(JudgedStream, ASoundOneIsBelievedToTheLastSample) {
  EXPECT_TRUE(judge().empty());
  EXPECT_LT(used_m, 3e-3);
}

TEST_F(JudgedStream, GapsAreNoBadSamples) {
  for (std::int64_t f = 60; f < 90; ++f) markers.set_missing(f, 5);
  for (std::int64_t f = 100; f < 104; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) markers.set_missing(f, m);
  EXPECT_THAT(judge(), ::testing::IsEmpty());
}

TEST_F(JudgedStream, TheOnlyMarkerOfASegmentIsBelievedWhenItComesBackAndNotWhereItCannotBe) {
  for (std::int64_t f = 0; f < kFrames; ++f) markers.set_missing(f, 6);
  const int only = 6;  // of those that are seen
  for (const std::int64_t frames : {10, 50, 100}) {
    const std::int64_t back = 70 + frames;
    auto whole = markers;
    for (std::int64_t f = 70; f < back; ++f) markers.set_missing(f, 7);
    EXPECT_THAT(judge(), ::testing::IsEmpty()) << frames;
    markers.x(back, 7) += Vector3d(0.0, 0.3, 0.0);
    EXPECT_THAT(judge(), ::testing::ElementsAre(Sample{back, only})) << frames;
    markers = whole;
  }
}

TEST_F(JudgedStream, ASpikeOfAnyMarkerIsReplacedByItsPositionOnTheBody) {
  for (int m = 0; m < body.marker_count(); ++m) {
    markers.x(130, m) += Vector3d(0.08, -0.05, 0.06);
    EXPECT_EQ(judge(), (std::set<Sample>{{130, m}})) << m;
    EXPECT_LT(used_m, 0.02) << m;
    markers.x(130, m) -= Vector3d(0.08, -0.05, 0.06);
  }
}

TEST_F(JudgedStream, BeforeAnythingIsLearntNothingIsAccused) {
  markers.x(kLearnt / 2, 4) += Vector3d(0.08, -0.05, 0.06);
  EXPECT_TRUE(judge().empty());
  EXPECT_GT(used_m, 0.1);
}

TEST_F(JudgedStream, ExchangedMarkersAreOutAsLongAsTheyAre) {
  exchange(1, 9, 120, 149);
  const auto out = judge();
  for (std::int64_t f = 120; f < 150; ++f)
    for (const int m : {1, 9}) EXPECT_TRUE(out.contains({f, m})) << f << ' ' << m;
  EXPECT_EQ(out.size(), 60U);
  EXPECT_LT(used_m, 0.03);
}

TEST_F(JudgedStream, AValueHeldWhileTheBodyMovesIsNotUsed) {
  for (std::int64_t f = 121; f < 141; ++f) markers.x(f, 7) = markers.x(120, 7);
  const auto out = judge();
  EXPECT_GE(out.size(), 15U);
  for (const auto& [f, m] : out) {
    EXPECT_EQ(m, 7);
    EXPECT_GE(f, 121);
    EXPECT_LT(f, 141);
  }
  EXPECT_LT(used_m, 0.02);
}

}  // namespace
}  // namespace kinemark::motion::internal
