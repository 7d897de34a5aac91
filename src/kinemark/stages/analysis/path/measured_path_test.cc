// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/measured_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/analysis/path/testing/known_noise.h"

namespace kinemark::analysis {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A reach, a marker that is everywhere the same, and two points of a model that hold nothing.
data::Trajectories reach_and_others() {
  const auto one = testing::recording_of(testing::sampled(170, 100.0, testing::reach), 100.0, 5e-4, 1);
  auto out = data::Trajectories::all_missing({"HAND", "NAIL", "PELO", "PELA"}, one.time);
  for (std::int64_t f = 0; f < one.frames(); ++f)
    for (int m = 0; m < 2; ++m) {
      out.x(f, m) = m == 0 ? Eigen::Vector3d(one.x(f, 0)) : Eigen::Vector3d(1.0, 2.0, 3.0);
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

std::vector<std::string> warnings_of(const data::Trajectories& markers, PathMeasureOptions options = {}) {
  options.measures = {"peak_speed"};
  const auto found = measure_paths(markers, options);
  if (!found) throw std::runtime_error(found.error().message);
  return found->warnings;
}

TEST(NotMeasuredMarkers, ThatLackTheSameShareASentence) {
  EXPECT_THAT(warnings_of(reach_and_others()),
              ElementsAre("2 markers (PELO, PELA) were measured in 0 frames; need 30 at least",
                          "the noise of NAIL is not known: no seven frames in a row differ; state it"));
  auto seldom = reach_and_others();
  for (std::int64_t f = 0; f < 12; ++f) {
    seldom.x(f, 2) = seldom.x(f, 0);
    seldom.state[seldom.index(f, 2)] = data::SampleState::measured;
  }
  EXPECT_THAT(warnings_of(seldom),
              Contains("2 markers (PELO, PELA) were measured in 0 to 12 frames; need 30 at least"));
}

TEST(NotMeasuredMarkers, AreNoneWhereAllIsThere) {
  auto markers = reach_and_others();
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (int m = 1; m < 4; ++m) {
      markers.x(f, m) = markers.x(f, 0) + Eigen::Vector3d(0.1 * m, 0.0, 0.0);
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  const auto said = warnings_of(markers);
  EXPECT_THAT(said, IsEmpty());
  EXPECT_THAT(said, Not(Contains(HasSubstr("frames; need 30 at least"))));
  EXPECT_THAT(said, Not(Contains(HasSubstr("is not known: no seven frames in a row differ"))));
}

TEST(NotMeasuredMarkers, StatedNoiseIsKnown) {
  const auto said = warnings_of(reach_and_others(), {.noise_sd_m = 5e-4});
  EXPECT_THAT(said, Not(Contains(HasSubstr("is not known: no seven frames in a row differ"))));
}

TEST(NotMeasuredMarkers, WhatTheRecorderMadeIsNoPath) {
  auto made = reach_and_others();
  for (std::int64_t f = 0; f < made.frames(); ++f)
    for (int m = 0; m < 2; ++m)
      if (f % 2 == 1) made.state[made.index(f, m)] = data::SampleState::upsampled;
  for (const double noise_sd_m : {0.0, 5e-4})
    EXPECT_THAT(
        warnings_of(made, {.noise_sd_m = noise_sd_m}),
        Contains("most samples of 2 markers (HAND, NAIL) were made by the recorder: 'kinemark clean IN "
                 "OUT --upsampled decimate' leaves those that it measured"));
  auto filled = reach_and_others();
  for (std::int64_t f = 60; f < 100; ++f) filled.state[filled.index(f, 0)] = data::SampleState::upsampled;
  EXPECT_THAT(warnings_of(filled), Not(Contains(HasSubstr("were made by the recorder")))) << "a span of them";
}

TEST(NotMeasuredMarkers, OfARateBelowMovementAreOneSentence) {
  auto slow = reach_and_others();
  slow.time.rate_hz = 0.8;
  EXPECT_THAT(warnings_of(slow), Contains("0.8 frames a second are too few to measure movement"));
  EXPECT_THAT(warnings_of(reach_and_others()), Not(Contains(HasSubstr("are too few to measure movement"))));
}

TEST(NotMeasuredSentences, SayWhatIsLacking) {
  const std::vector<NotMeasured> markers{
      {.subject = "A", .why = NotMeasuredWhy::no_smoother, .samples = 40, .rate_hz = 100.0},
      {.subject = "B", .why = NotMeasuredWhy::too_few_samples, .samples = 29, .rate_hz = 100.0},
      {.subject = "C", .why = NotMeasuredWhy::no_smoother, .samples = 41, .rate_hz = 100.0}};
  EXPECT_THAT(not_measured_sentences(markers),
              ElementsAre("B was measured in 29 frames; need 30 at least",
                          "no smoother fits the samples of 2 markers (A, C)"));
  EXPECT_THAT(not_measured_sentences({}), IsEmpty());
  EXPECT_THAT(not_measured_sentences({&markers[1], 1}),
              Not(Contains(HasSubstr("no smoother fits the samples of"))));
}

PathMeasures measures_of(const SeriesMatrix& x) {
  auto found =
      measure_paths(testing::recording_of(x, 100.0, 0.0, 1), {.measures = {"path_length"}, .refits = 39});
  if (!found) throw std::runtime_error(found.error().message);
  return std::move(*found);
}

TEST(MeasuredPathTest, NoiseThatFitsNoModelLeavesValuesWithoutIntervals) {
  SeriesMatrix x = testing::cycles_with(testing::white(1e-4), 6);
  for (std::int64_t i = 0; i < testing::kSamples; ++i)
    x.row(i).array() += 2e-3 * (std::sin(testing::kTurn * 0.30 * static_cast<double>(i)) +
                                std::sin(testing::kTurn * 0.44 * static_cast<double>(i)));
  const auto spoiled = measures_of(x), right = measures_of(testing::cycles_with(testing::white(1e-4), 6));
  EXPECT_TRUE(std::isfinite(spoiled.measures.front().value));
  EXPECT_EQ(spoiled.measures.front().remark, "no interval: the noise above the movement fits no model");
  EXPECT_EQ(right.measures.front().interval.kind, data::IntervalKind::two_sided);
  EXPECT_THAT(right.measures.front().remark, Not(HasSubstr("the noise above the movement fits no model")));
}

TEST(MeasuredPathTest, NoiseBelowTheRoundingLeavesValuesWithoutIntervals) {
  SeriesMatrix x = testing::drifting_cycles_with(testing::white(2e-6), 5);
  const auto fine = measures_of(testing::cycles_with(testing::white(2e-4), 5));
  for (auto& value : x.reshaped()) value = 7.4e-5 * std::round(value / 7.4e-5);
  const auto coarse = measures_of(x);
  EXPECT_EQ(coarse.measures.front().remark,
            "no interval: the noise is below the rounding of the file (0.074 mm)");
  EXPECT_THAT(fine.measures.front().remark, Not(HasSubstr("the noise is below the rounding of the file (")));
}

TEST(MeasuredPathTest, ShortStretchesSayHowShort) {
  const auto markers = testing::recording_of(testing::sampled(170, 100.0, testing::reach), 100.0, 5e-4, 1);
  const auto path = MeasuredPath::create(markers, 0, {.refits = 0});
  ASSERT_TRUE(path);
  const auto blink = path->measure({"blink", 50, 52});
  ASSERT_FALSE(blink);
  EXPECT_EQ(blink.error(), "3 frames without the edges of 80 ms; need 5 at least");
  const auto glance = path->measure({"glance", 50, 54});
  EXPECT_FALSE(!glance && glance.error().contains("frames without the edges of "));
  EXPECT_TRUE(glance);
  const auto beat = path->rhythm({"beat", 50, 60});
  ASSERT_FALSE(beat);
  EXPECT_EQ(beat.error(), "11 frames are too few for a movement; need 20");
  const auto bar = path->rhythm({"bar", 50, 80});
  EXPECT_FALSE(!bar && bar.error().contains("frames are too few for a movement; need"));
}

TEST(MeasuredPathTest, OutliersAreLeftOutUnlessTheyAreKept) {
  SeriesMatrix x = testing::cycles_with(testing::white(3e-4), 9);
  for (const std::int64_t i : {100, 230, 333}) x(i, 1) += 8e-3;
  const auto markers = testing::recording_of(x, 100.0, 0.0, 1);
  const auto clean = measures_of(testing::cycles_with(testing::white(3e-4), 9));
  const auto without = measure_paths(markers, {.measures = {"path_length"}, .refits = 0}),
             with = measure_paths(markers, {.measures = {"path_length"}, .refits = 0, .keep_outliers = true});
  ASSERT_TRUE(without && with);
  EXPECT_EQ(without->noises.front().outliers, 3);
  EXPECT_NEAR(without->measures.front().share_not_measured, 3.0 / 484.0, 1e-9)
      << "without the edges of 8 samples";
  EXPECT_EQ(with->measures.front().share_not_measured, 0.0);
  EXPECT_GT(with->measures.front().value, without->measures.front().value);
  EXPECT_NEAR(with->noises.front().sd_m(), clean.noises.front().sd_m(), 4e-5)
      << "the noise is that of the others";
}

TEST(MeasuredPathTest, FlickersBesideEachOtherAreNoAcceleration) {
  constexpr double kFlicker_m = 3e-3;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SeriesMatrix x = testing::cycles_with(testing::white(6e-5), seed);
    const auto clean = measure_paths(testing::recording_of(x, 100.0, 0.0, 1),
                                     {.measures = {"peak_acceleration"}, .refits = 0});
    for (const std::int64_t i : {60, 63, 150, 151, 240, 242, 330}) {
      const double angle = 0.7 * static_cast<double>(i);
      x(i, 0) += kFlicker_m * std::cos(angle), x(i, 1) += kFlicker_m * std::sin(angle);
    }
    const auto flickering = measure_paths(testing::recording_of(x, 100.0, 0.0, 1),
                                          {.measures = {"peak_acceleration"}, .refits = 0});
    ASSERT_TRUE(clean && flickering);
    EXPECT_GE(flickering->noises.front().outliers, 7);
    EXPECT_NEAR(flickering->measures.front().value, clean->measures.front().value,
                0.05 * clean->measures.front().value)
        << seed;
  }
}

/// 0.06 m up and down once in 0.6 s: at the bottom the velocity turns round.
Eigen::Vector3d tapping(double t) { return {0.06 * std::abs(std::sin(M_PI * (t - 0.4) / 0.6)), 0.0, 1.0}; }

TEST(MeasuredJumps, TappingIsNoCorrelatedNoiseAndHasNoLargestAcceleration) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto markers = testing::recording_of(testing::sampled(1600, 200.0, tapping), 200.0, 3e-4, seed);
    const auto found = measure_paths(markers, {.measures = {"peak_acceleration", "peak_speed"}});
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->noises.front().correlated()) << seed;
    EXPECT_NEAR(found->noises.front().sd_m(), 3e-4, 3e-5);
    EXPECT_EQ(found->measures[0].interval.kind, data::IntervalKind::none) << seed;
    EXPECT_EQ(found->measures[1].interval.kind, data::IntervalKind::at_least) << seed;
    EXPECT_THAT(found->measures[1].remark, HasSubstr("the velocity jumps (13 times, first at 0.4"));
  }
}

TEST(MeasuredJumps, ASharpStopLiesInTheIntervalsAndASmoothOneIsNotAccused) {
  const auto stop = [](double t) {
    const double u = std::clamp((t - 1.0) / 0.65, 0.0, 1.0);
    return Eigen::Vector3d(0.35 * u * u * u * (4.0 - 3.0 * u), 0.0, 1.0);
  };
  const double ends_s = 1.0 + 0.65 * 0.99248, largest = 12.0 * 0.35 / 0.65 / 0.65;
  int end_held = 0, acceleration_held = 0, accused = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const PathMeasureOptions options{.measures = {"peak_acceleration", "movement_end"}};
    const auto sharp =
        measure_paths(testing::recording_of(testing::sampled(300, 100.0, stop), 100.0, 5e-4, seed), options);
    ASSERT_TRUE(sharp);
    const auto& acceleration = sharp->measures[0].interval;
    const auto& end = sharp->measures[1].interval;
    acceleration_held += acceleration.low <= largest && largest <= acceleration.high;
    end_held += end.low <= ends_s && ends_s <= end.high;
    const auto smooth = measure_paths(
        testing::recording_of(testing::sampled(300, 100.0, testing::reach), 100.0, 5e-4, seed), options);
    ASSERT_TRUE(smooth);
    for (const auto& one : smooth->measures) accused += one.remark.find("jumps") != std::string::npos;
  }
  EXPECT_GE(end_held, 17);
  EXPECT_GE(acceleration_held, 17);
  EXPECT_EQ(accused, 0);
}

}  // namespace
}  // namespace kinemark::analysis
