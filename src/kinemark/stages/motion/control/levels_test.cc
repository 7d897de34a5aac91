// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Several levels: weights in one sum of squares, and strict ones that say when they leave their goals.
#include "kinemark/stages/motion/control/internal/levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/motion/control/online_tracker.h"
#include "kinemark/stages/motion/control/tasks.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing_body::angle_rms;
using testing_body::record;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

std::vector<TrackLevel> trunk_and_rest() {
  return {{.markers = {"T1", "T2", "T3", "T4"}}, {.markers = {"*"}}};
}

/// The markers of the limbs have so much noise besides.
data::Trajectories noisy_limbs(const model::Model& model, std::int64_t frames, double sd_m) {
  auto markers = record(model, frames, 1e-3, 3);
  Random random(5, 1);
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 4; m < markers.markers(); ++m)
      for (int axis = 0; axis < 3; ++axis) markers.x(f, m)[axis] += sd_m * random.gaussian();
  return markers;
}

/// The trunk's markers lie where no pose has them, from frame 60 to 110.
data::Trajectories contradicting(const model::Model& model, double off_m) {
  auto markers = record(model, 200, 1e-4, 3);
  for (std::int64_t f = 60; f < 110; ++f) {
    const double size = off_m * std::pow(std::sin(0.0628 * static_cast<double>(f - 60)), 2);
    markers.x(f, 0) += Eigen::Vector3d(size, size, 0.0);
    markers.x(f, 1) -= Eigen::Vector3d(size, -size, size);
    markers.x(f, 2) += Eigen::Vector3d(0.0, -size, size);
  }
  return markers;
}

TEST(Levels, WeightsAreAsGivenAndOneOnAverage) {
  const auto model = body();
  auto levels = trunk_and_rest();
  levels[0].weight = 9.0;
  levels[1].weight = 3.0;
  const auto plan = internal::make_plan(model, record(model, 4), {.levels = levels}).value();
  ASSERT_EQ(plan.levels.size(), 1U);
  EXPECT_EQ(plan.asked.size(), 2U);
  EXPECT_TRUE(plan.one_sum);
  EXPECT_NEAR(plan.level_weights[0] / plan.level_weights[1], 3.0, 1e-12);
  EXPECT_NEAR(plan.problem.weight.mean(), 1.0, 1e-12);
  EXPECT_EQ(plan.problem.weight[0], plan.level_weights[0]);
  EXPECT_EQ(plan.problem.weight[13], plan.level_weights[1]);
  levels[1].weight = 0.0;
  const auto refused = internal::make_plan(model, record(model, 4), {.levels = levels});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("level 2 weighs 0; give each level a weight above 0, or none"));
}

TEST(Levels, WithoutARunEachCountsFourTimesTheNext) {
  const auto model = body();
  const auto plan =
      internal::make_plan(model, record(model, 4),
                          {.levels = {{.markers = {"T1"}}, {.markers = {"U1"}}, {.markers = {"*"}}}})
          .value();
  EXPECT_NEAR(plan.level_weights[0] / plan.level_weights[1], 4.0, 1e-12);
  EXPECT_NEAR(plan.level_weights[0] / plan.level_weights[2], 16.0, 1e-12);
  const auto strict =
      internal::make_plan(model, record(model, 4), {.levels = trunk_and_rest(), .strict = true});
  EXPECT_EQ(strict->levels.size(), 2U);
  EXPECT_THAT(strict->level_weights, IsEmpty());
}

TEST(Levels, TheWeightOfATaskIsThatOfItsLevel) {
  const auto model = body();
  auto levels = trunk_and_rest();
  levels[0].tasks = {coordinate_task("elbow", {0.5}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 1})};
  levels[0].weight = 4.0;
  levels[1].weight = 1.0;
  const auto plan = internal::make_plan(model, record(model, 4), {.levels = levels}).value();
  EXPECT_FALSE(plan.one_sum);
  ASSERT_EQ(plan.levels[0].task_weights.size(), 1U);
  EXPECT_EQ(plan.levels[0].task_weights[0], plan.level_weights[0]);
  EXPECT_EQ(plan.levels[0].rows(), 3 * 14 + 1);
}

TEST(Levels, NoisyMarkersCountAsMuchAsTheyKnow) {
  const auto model = body();
  const auto markers = noisy_limbs(model, 400, 7e-3);
  const auto track =
      track_markers(model, markers, {.levels = trunk_and_rest(), .judge_samples = false, .error_bars = false})
          .value();
  const double ratio = track.levels[0].weight / track.levels[1].weight;
  EXPECT_GT(ratio, 15.0);  // (1 + 49) : 1 of the samples, and 0.3 mm at least of the goals
  EXPECT_LT(ratio, 100.1);
  const auto flat = track_markers(model, markers, {.judge_samples = false, .error_bars = false}).value();
  EXPECT_LT(angle_rms(model, track.motion), angle_rms(model, flat.motion));
  EXPECT_EQ(track.solves, 0);
  EXPECT_THAT(track.fit.findings, IsEmpty());
  EXPECT_THAT(track.fit.warnings, IsEmpty());
  const auto even =
      track_markers(model, record(model, 400, 3e-3, 3), {.levels = trunk_and_rest(), .error_bars = false})
          .value();
  EXPECT_NEAR(even.levels[0].weight / even.levels[1].weight, 1.0, 0.4);
  EXPECT_TRUE(std::isnan(even.levels[0].bound_m));
  EXPECT_GT(even.levels[1].rms_error_m, 1e-4);
  EXPECT_LE(even.levels[1].rms_error_m, even.levels[1].max_error_m);
}

TEST(Levels, WhereThePoseExplainsNearlyAllOneInFourIsUsed) {
  const auto model = body();
  // Two markers a segment: no residual tells of their noise.
  const auto track =
      track_markers(
          model, record(model, 100, 1e-3, 3),
          {.levels = {{.markers = {"T1"}}, {.markers = {"F2"}}}, .judge_samples = false, .error_bars = false})
          .value();
  EXPECT_NEAR(track.levels[0].weight / track.levels[1].weight, 4.0, 1e-9);
}

TEST(Levels, AStreamWithTheSameWeightsHasTheSameNumbers) {
  const auto model = body();
  const auto markers = record(model, 80, 1e-3, 3);
  auto levels = trunk_and_rest();
  levels[0].weight = 2.0;
  levels[1].weight = 1.0;
  const TrackOptions options{.levels = levels, .judge_samples = false, .error_bars = false};
  const auto file = track_markers(model, markers, options).value();
  auto tracker = OnlineTracker::create(model, markers.names, 100.0, options).value();
  std::int64_t compared = 0;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    Eigen::Matrix3Xd x(3, markers.markers());
    for (std::int64_t m = 0; m < markers.markers(); ++m) x.col(m) = markers.x(f, m);
    ASSERT_TRUE(tracker.push(markers.time.time_s(f), x));
    while (const auto* pose = tracker.next().value()) {
      for (std::int64_t c = 0; c < file.motion.size(); ++c)
        EXPECT_NEAR(pose->q[c], file.motion.q[file.motion.index(pose->frame, c)], 1e-9);
      ++compared;
    }
  }
  EXPECT_GT(compared, 40);
}

TEST(Levels, StrictOnesThatKeepTheirBoundsSayNothing) {
  const auto model = body();
  const auto track =
      track_markers(model, record(model, 200, 1e-3, 3), {.levels = trunk_and_rest(), .strict = true}).value();
  for (const char* absent :
       {"strict levels contradict one another in", "was farther from its goals than its bound of",
        "strict levels were followed in one sum of squares in"}) {
    EXPECT_THAT(track.fit.warnings, Not(Contains(HasSubstr(absent))));
  }
  EXPECT_THAT(track.fit.findings, IsEmpty());
  EXPECT_EQ(track.relaxations, 0);
  for (const auto& level : track.levels) {
    EXPECT_EQ(level.beyond, 0);
    EXPECT_LT(level.max_error_m, level.bound_m);
    EXPECT_TRUE(std::isnan(level.weight));
  }
}

TEST(Levels, AStrictLevelThatLeavesItsGoalsIsFoundInItsFramesAndComesBack) {
  const auto model = body();
  const auto markers = contradicting(model, 0.03);
  const TrackOptions options{
      .levels = trunk_and_rest(), .strict = true, .level_bound_m = 0.012, .judge_samples = false};
  const auto track = track_markers(model, markers, options).value();
  ASSERT_FALSE(track.fit.findings.empty());
  const auto& finding = track.fit.findings.front();
  EXPECT_EQ(finding.subject, "level 1");
  EXPECT_THAT(finding.description,
              HasSubstr("level 1 was farther from its goals than its bound of 12.0 mm in"));
  EXPECT_THAT(finding.description, HasSubstr("of them it cannot be met, not even by all levels in one sum"));
  EXPECT_THAT(track.fit.warnings,
              Contains(HasSubstr("strict levels were followed in one sum of squares in")));
  EXPECT_THAT(track.fit.warnings,
              Not(Contains(HasSubstr("; all levels are followed in one sum of squares instead"))));
  std::vector<std::int64_t> beyond;
  for (std::int64_t f = 0; f < 200; ++f) {
    const auto i = static_cast<std::size_t>(f);
    if (track.level_error[2 * i] > 0.012) beyond.push_back(f);
    if (std::max(track.level_error[2 * i], track.level_error[2 * i + 1]) > 0.012) {
      EXPECT_EQ(track.motion.status[i], data::FrameStatus::not_converged) << f;
    } else {
      EXPECT_EQ(track.motion.status[i], data::FrameStatus::converged) << f;
    }
  }
  EXPECT_EQ(finding.frames, beyond);
  EXPECT_EQ(track.relaxations, 1);
  EXPECT_EQ(std::ranges::count(track.relaxed, 1), 100) << "a second";
  EXPECT_EQ(track.relaxed[199], 0);
}

TEST(Levels, LevelsThatContradictOneAnotherAllTheTimeAreSaidBeforeAndJoined) {
  // The trunk's goals and those of the limbs lie on bodies of different size.
  auto described = testing_body::description();
  const auto model = model::Model::compile(described).value();
  for (auto& marker : described.markers)
    if (marker.body_idx == 0) marker.x_in_body *= 1.35;
  const auto markers = record(model::Model::compile(described).value(), 200);
  const TrackOptions options{
      .levels = trunk_and_rest(), .strict = true, .level_bound_m = 0.01, .judge_samples = false};
  const auto track = track_markers(model, markers, options).value();
  EXPECT_THAT(track.fit.warnings,
              Contains(HasSubstr("strict levels contradict one another in 2 of 2 poses")));
  EXPECT_THAT(track.fit.warnings,
              Contains(HasSubstr("; all levels are followed in one sum of squares instead")));
  EXPECT_THAT(track.fit.warnings, Contains(HasSubstr(", to the end")));
  EXPECT_EQ(std::ranges::count(track.relaxed, 1), 200);
  EXPECT_GT(track.levels[0].beyond, 150);
  EXPECT_GT(track.levels[0].unmet, 100);
}

}  // namespace
}  // namespace kinemark::motion
