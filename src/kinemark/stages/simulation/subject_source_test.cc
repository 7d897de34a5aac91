// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/subject_source.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <vector>

#include "kinemark/stages/simulation/subject.h"
#include "kinemark/stages/simulation/testing/models.h"

namespace kinemark::simulation {
namespace {

using ::testing::HasSubstr;

std::shared_ptr<const model::Model> somebody() {
  return {std::shared_ptr<const model::Model>(), &human()};  // outlives every test
}

std::unique_ptr<SubjectSource> source_of(const SubjectOptions& options) {
  return SubjectSource::create(somebody(), options, {.name = "sim:walk"}).value();
}

TEST(SubjectSource, GivesTheFramesOfTheWholeSimulationToTheBit) {
  const SubjectOptions options{.motion = MotionKind::walk, .duration_s = 3.0, .seed = 4, .full_turns = 0.5};
  const auto whole = simulate_subject(human(), options).value().markers;
  const auto source = source_of(options);
  EXPECT_EQ(source->facts().markers, whole.names);
  EXPECT_EQ(source->facts().frames, whole.frames());
  EXPECT_EQ(source->facts().name, "sim:walk");
  stream::Frame frame;
  for (std::int64_t f = 0; f < whole.frames(); ++f) {
    ASSERT_EQ(source->next(frame), true);
    ASSERT_EQ(frame.number, f);
    ASSERT_EQ(frame.time_s, whole.time.time_s(f));
    for (std::int64_t m = 0; m < whole.markers(); ++m)
      ASSERT_EQ(Eigen::Vector3d::Map(&frame.x_in_world[static_cast<std::size_t>(3 * m)]), whole.x(f, m));
  }
  EXPECT_EQ(source->next(frame), false);
}

TEST(SubjectSource, LosesTheShareThatIsAskedForInGapsOfTheSameLengths) {
  struct Case {
    double share, rate_hz;
  };
  for (const auto& [share, rate_hz] :
       {Case{0.1, 100.0}, {0.5, 100.0}, {0.9, 100.0}, {0.5, 10.0}, {0.9, 30.0}, {0.2, 1.0}}) {
    const SubjectOptions options{
        .duration_s = 6000.0 / rate_hz, .rate_hz = rate_hz, .noise_sd_m = 0.0, .dropout_random = share};
    const auto source = source_of(options);
    const auto markers = source->facts().markers.size();
    std::vector<bool> before(markers, false);
    double lost = 0.0, samples = 0.0, gaps = 0.0;
    for (stream::Frame frame; source->next(frame).value();)
      for (std::size_t m = 0; m < markers; ++m) {
        const bool is_lost = frame.state[m] == data::SampleState::missing;
        ASSERT_EQ(std::isnan(frame.x_in_world[3 * m]), is_lost);
        samples += 1.0, lost += is_lost, gaps += is_lost && !before[m];
        before[m] = is_lost;
      }
    EXPECT_NEAR(lost / samples, share, 0.03) << rate_hz << " Hz";
    if (share == 0.1) {
      EXPECT_NEAR(lost / gaps / options.rate_hz, 0.192, 0.04) << "s, where gaps hardly touch";
    }
  }
}

TEST(SubjectSource, MarkersStayNearWhatIsSaidOfTheirExtent) {
  const auto source = source_of({.motion = MotionKind::tai_chi, .duration_s = 40.0, .rate_hz = 20.0});
  const auto [low, high] = source->facts().extent_m.value();
  for (stream::Frame frame; source->next(frame).value();)
    for (std::size_t i = 0; i < frame.x_in_world.size(); ++i) {
      const auto axis = static_cast<Eigen::Index>(i % 3);
      EXPECT_GT(frame.x_in_world[i], low[axis] - 0.1);
      EXPECT_LT(frame.x_in_world[i], high[axis] + 0.1);
    }
}

TEST(SubjectSource, WhatNeedsTheWholeRecordingIsRefused) {
  for (const auto& options : {SubjectOptions{.soft_tissue = 0.5}, SubjectOptions{.dropout_sight = 0.1}}) {
    const auto refused = SubjectSource::create(somebody(), options, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::usage);
    EXPECT_THAT(refused.error().message, HasSubstr("need a whole recording"));
  }
  EXPECT_FALSE(SubjectSource::create(somebody(), {.duration_s = -1.0}, {}));
}

}  // namespace
}  // namespace kinemark::simulation
