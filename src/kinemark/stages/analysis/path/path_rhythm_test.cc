// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/path_rhythm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/analysis/path/path_measures.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis {
namespace {

using ::testing::HasSubstr;
using testing::kTurn;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double kWay_s = 0.7, kRest_s = 0.6;
// Onset of a minimum-jerk way by 5 % of its peak speed, in shares of it.
const double kOnset = 0.5 - std::sqrt(0.25 - std::sqrt(0.05) / 4.0);

// Out by 0.3 m, a rest, back, a rest, three times, from 0.6 s on.
Eigen::Vector3d out_and_back(double t) {
  double x = 0.0;
  for (int k = 0; k < 6; ++k)
    x += (k % 2 == 0 ? 0.3 : -0.3) * testing::minimum_jerk((t - kRest_s - k * (kWay_s + kRest_s)) / kWay_s);
  return {x, 0.2 * x, 0.8};
}

PathRhythm rhythm_of(const data::Trajectories& markers, PathMeasureOptions options = {.refits = 59}) {
  options.rhythms = true;
  auto found = measure_paths(markers, options);
  if (!found) throw std::runtime_error(found.error().message);
  if (found->rhythms.size() != 1) throw std::runtime_error("no rhythm");
  return std::move(found->rhythms.front());
}

data::Trajectories reaches(double noise_m = 5e-4, std::uint64_t seed = 1) {
  return testing::recording_of(testing::sampled(860, 100.0, out_and_back), 100.0, noise_m, seed);
}

TEST(PathRhythm, EveryReachHasAStartAndAnEndWithADeviation) {
  const auto found = rhythm_of(reaches());
  std::vector<double> starts, ends;
  for (const auto& event : found.events) {
    EXPECT_GT(event.sd_s, 1e-4);
    EXPECT_LT(event.sd_s, 0.02);
    if (event.kind == PathEventKind::movement_start) starts.push_back(event.time_s);
    if (event.kind == PathEventKind::movement_end) ends.push_back(event.time_s);
  }
  ASSERT_EQ(starts.size(), 6u);
  ASSERT_EQ(ends.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    const double begin = kRest_s + static_cast<double>(k) * (kWay_s + kRest_s);
    EXPECT_NEAR(starts[k], begin + kOnset * kWay_s, 0.02);
    EXPECT_NEAR(ends[k], begin + (1.0 - kOnset) * kWay_s, 0.02);
  }
  EXPECT_TRUE(std::ranges::is_sorted(found.events, {}, &PathEvent::time_s));
  EXPECT_THAT(found.verdict, HasSubstr("6 movements between rests"));
}

TEST(PathRhythm, WaysOutAndBackAreAveragedApart) {
  const auto found = rhythm_of(reaches());
  std::vector<std::string> names;
  for (const auto& curve : found.curves) {
    EXPECT_TRUE(curve.validate());
    if (curve.id == "x" && curve.context.starts_with("movement")) names.push_back(curve.context);
    if (curve.id != "x" || curve.context != "movement 1") continue;
    ASSERT_EQ(curve.count(), 3);
    for (std::int64_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(curve(c, 0), 0.3 * testing::minimum_jerk(kOnset), 2e-3);
      EXPECT_NEAR(curve(c, 50), 0.15, 5e-3);
      EXPECT_GT(curve.sd[static_cast<std::size_t>(c * 101 + 50)], 1e-4);
    }
  }
  EXPECT_EQ(names, (std::vector<std::string>{"movement 1", "movement 2"}));
  const auto durations = std::ranges::count(found.measures, "repetition_duration", &data::Measure::id);
  EXPECT_EQ(durations, 6);
  for (const auto& measure : found.measures) {
    EXPECT_TRUE(measure.validate()) << measure.id;
    if (measure.id == "repetition_duration") {
      EXPECT_NEAR(measure.value, (1.0 - 2.0 * kOnset) * kWay_s, 0.03);
    } else if (measure.id == "repetition_variation") {
      EXPECT_EQ(measure.interval.kind, data::IntervalKind::at_most);
    }
  }
}

// Cycles of 0.8 s whose frequency wavers by 8 %.
double angle_at(double t) { return kTurn * t / 0.8 + 0.3 * std::sin(kTurn * 0.31 * t); }
Eigen::Vector3d wavering(double t) {
  return {0.2 * std::cos(angle_at(t)), 0.1 * std::sin(angle_at(t)), 0.02 * std::cos(2.0 * angle_at(t))};
}

TEST(PathRhythm, CyclesHaveTheirLengthsAndTheVariationOfThem) {
  const auto markers = testing::recording_of(testing::sampled(800, 100.0, wavering), 100.0, 1e-3, 2);
  const auto found = rhythm_of(markers, {.refits = 99});
  ASSERT_TRUE(found.periodic) << found.verdict;
  EXPECT_NEAR(found.period_s, 0.8, 0.03);
  EXPECT_THAT(found.verdict, HasSubstr("cycles of 0."));
  std::vector<data::Measure> cycles;
  for (const auto& measure : found.measures)
    if (measure.id == "cycle_duration") cycles.push_back(measure);
  ASSERT_GE(cycles.size(), 8u);
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    EXPECT_EQ(cycles[i].cycle, static_cast<std::int64_t>(i));
    // From one upward crossing to the next the angle goes around once.
    EXPECT_NEAR(angle_at(cycles[i].end_s) - angle_at(cycles[i].start_s), kTurn, 0.05);
    EXPECT_EQ(cycles[i].interval.kind, data::IntervalKind::two_sided);
    EXPECT_NEAR(cycles[i].value, cycles[i].end_s - cycles[i].start_s, 2e-3);
  }
  const auto variation = std::ranges::find(found.measures, "cycle_variation", &data::Measure::id);
  ASSERT_NE(variation, found.measures.end());
  EXPECT_GT(variation->value, 0.01);
  EXPECT_LT(variation->interval.low, variation->value);
  EXPECT_GT(variation->interval.high, variation->value);
  ASSERT_EQ(found.curves.size(), 4u);
  EXPECT_EQ(found.curves[3].id, "speed");
  EXPECT_EQ(found.curves[0].context, "cycle");
}

TEST(PathRhythm, SaysWhyAMovementHasNoCycles) {
  const auto reach = testing::recording_of(testing::sampled(170, 100.0, testing::reach), 100.0, 5e-4, 1);
  const auto found = rhythm_of(reach);
  EXPECT_FALSE(found.periodic);
  EXPECT_THAT(found.verdict, Not(HasSubstr(" whole cycle")));
  EXPECT_THAT(found.verdict, StartsWith("not periodic: "));
  EXPECT_THAT(found.verdict, HasSubstr("1 movement between rests"));
  EXPECT_TRUE(std::isnan(found.period_s));
  for (const auto& event : found.events) EXPECT_NE(event.kind, PathEventKind::cycle_start);
  const auto still = testing::recording_of(SeriesMatrix::Zero(300, 3), 100.0, 1e-3, 1);
  const auto none = rhythm_of(still);
  EXPECT_TRUE(none.events.empty());
  EXPECT_THAT(none.verdict, HasSubstr("less than half the noise"));
}

// The longer an ellipse is followed the more of it is seen: somewhere between, it is like itself and no two
// are whole.
TEST(PathRhythm, OneWholeCycleIsTooFew) {
  int said = 0;
  for (int frames = 100; frames <= 400; frames += 20) {
    const auto found =
        rhythm_of(testing::recording_of(testing::sampled(frames, 100.0, testing::ellipse), 100.0, 5e-4, 1),
                  {.refits = 0});
    const bool one = found.verdict.starts_with("not periodic: 1 whole cycle of ") ||
                     found.verdict.starts_with("not periodic: 0 whole cycles of ");
    EXPECT_FALSE(one && found.periodic);
    said += one ? 1 : 0;
  }
  EXPECT_GT(said, 0);
}

TEST(PathRhythm, AWalkHasItsCyclesWithoutTheWay) {
  const auto walk = [](double t) -> Eigen::Vector3d {
    return {1.3 * t + 0.25 * std::sin(kTurn * 0.9 * t), 0.0, 0.1 + 0.05 * std::cos(kTurn * 0.9 * t)};
  };
  const auto found = rhythm_of(testing::recording_of(testing::sampled(600, 100.0, walk), 100.0, 5e-4, 3));
  ASSERT_TRUE(found.periodic) << found.verdict;
  const auto& x = found.curves.front();
  // The mean place of a cycle stays where it was; a stride is 1.44 m.
  std::vector<double> means;
  for (std::int64_t c = 0; c < x.count(); ++c) {
    means.push_back(0.0);
    for (std::int64_t p = 0; p < 100; ++p) means.back() += 0.01 * x(c, p);
  }
  ASSERT_GE(means.size(), 3u);
  for (const double mean : means) EXPECT_NEAR(mean, means.front(), 2e-3);
}

TEST(PathRhythm, WhatHappensInALongGapIsLeftOut) {
  auto markers = reaches();
  for (std::int64_t f = 180; f < 215; ++f) markers.state[markers.index(f, 0)] = data::SampleState::missing;
  const auto found = rhythm_of(markers);
  for (const auto& event : found.events)
    EXPECT_FALSE(event.time_s > 1.8 && event.time_s < 2.15) << event.time_s;
  EXPECT_EQ(std::ranges::count(found.measures, "repetition_duration", &data::Measure::id), 5);
}

TEST(PathRhythm, WithoutRefitsNothingIsSaidOfTheNoise) {
  const auto found = rhythm_of(reaches(), {.refits = 0});
  EXPECT_EQ(std::ranges::count_if(found.events,
                                  [](const PathEvent& e) { return e.kind != PathEventKind::cycle_start; }),
            12);
  for (const auto& event : found.events) EXPECT_TRUE(std::isnan(event.sd_s));
  for (const auto& curve : found.curves) EXPECT_TRUE(curve.sd.empty());
  for (const auto& measure : found.measures) EXPECT_EQ(measure.interval.kind, data::IntervalKind::none);
}

TEST(PathRhythm, MeasuresOfItAloneNeedNoOthers) {
  const auto found = measure_paths(reaches(), {.measures = {"repetition_duration"}, .refits = 39});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->measures.size(), 6u);
  for (const auto& measure : found->measures) EXPECT_EQ(measure.id, "repetition_duration");
  const auto wrong = measure_paths(reaches(), {.measures = {"cycle_durations"}});
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("nearest: cycle_duration"));
}

TEST(PathRhythm, MethodsSayByWhatEventsWereFound) {
  const auto reach = testing::recording_of(testing::sampled(170, 100.0, testing::reach), 100.0, 5e-4, 1);
  const auto moved = rhythm_of(reach, {.refits = 39});
  EXPECT_FALSE(moved.measures.empty());
  for (const auto& measure : moved.measures) {
    if (!measure.id.starts_with("repetition")) continue;
    EXPECT_THAT(measure.method, StartsWith("5 % of the peak speed, 39 refits, smoothed to "));
    EXPECT_THAT(measure.method, Not(HasSubstr("crossings of the mean")));
  }
  const auto markers = testing::recording_of(testing::sampled(400, 100.0, wavering), 100.0, 1e-3, 2);
  const auto turned = rhythm_of(markers, {.refits = 39});
  EXPECT_FALSE(turned.measures.empty());
  for (const auto& measure : turned.measures) {
    if (!measure.id.starts_with("cycle")) continue;
    EXPECT_THAT(measure.method, StartsWith("crossings of the mean, 39 refits, smoothed to "));
    EXPECT_THAT(measure.method, Not(HasSubstr("5 % of the peak speed")));
  }
}

// Up and down once a second as ever, and to and fro in its own time.
TEST(PathRhythm, ALikeMovementMayHaveUnevenCycles) {
  bool said = false;
  for (const double swing : {0.40, 0.42, 0.44, 0.46}) {
    const auto uneven = [=](double t) -> Eigen::Vector3d {
      return {0.2 * std::cos(kTurn * (t + swing * std::sin(kTurn * 0.37 * t))), 0.0,
              0.12 * std::cos(kTurn * t)};
    };
    const auto found = rhythm_of(testing::recording_of(testing::sampled(1000, 100.0, uneven), 100.0, 5e-4, 1),
                                 {.refits = 0});
    const bool differ = found.verdict.starts_with("not periodic: its cycles differ by ");
    EXPECT_FALSE(differ && found.periodic);
    said = said || differ;
  }
  EXPECT_TRUE(said);
}

TEST(PathRhythm, AFallingLikenessAndUnevenCyclesSaySo) {
  // Six frequencies that have no period together: its velocity is like itself by 0.19 at most.
  const auto wander = [](double t) -> Eigen::Vector3d {
    return {0.1 * std::sin(kTurn * 0.53 * t) + 0.05 * std::sin(kTurn * 1.13 * t + 1.0),
            0.1 * std::sin(kTurn * 0.71 * t + 2.0) + 0.04 * std::sin(kTurn * 1.37 * t),
            0.1 * std::sin(kTurn * 0.91 * t + 0.5) + 0.05 * std::sin(kTurn * 0.37 * t)};
  };
  const auto unlike =
      rhythm_of(testing::recording_of(testing::sampled(700, 100.0, wander), 100.0, 5e-4, 1), {.refits = 0});
  EXPECT_THAT(unlike.verdict, HasSubstr("s, where it is most like itself, its velocities correlate by "));
  // Turns that hasten and slow down twice in ten seconds.
  const auto hastening = [](double t) -> Eigen::Vector3d {
    const double angle = kTurn * (t + 0.5 * std::sin(kTurn * 0.2 * t));
    return {0.2 * std::cos(angle), 0.1 * std::sin(angle), 0.0};
  };
  const auto never = rhythm_of(
      testing::recording_of(testing::sampled(1000, 100.0, hastening), 100.0, 5e-4, 1), {.refits = 0});
  EXPECT_THAT(never.verdict, HasSubstr("not periodic: it does not come back to what it did"));
  const auto even = rhythm_of(
      testing::recording_of(testing::sampled(500, 100.0, testing::ellipse), 100.0, 5e-4, 1), {.refits = 0});
  EXPECT_TRUE(even.periodic);
  EXPECT_THAT(even.verdict, Not(HasSubstr("where it is most like itself, its velocities correlate by")));
  EXPECT_THAT(even.verdict, Not(HasSubstr("not periodic: its cycles differ by ")));
  EXPECT_THAT(even.verdict, Not(HasSubstr("not periodic: ")));
  EXPECT_THAT(even.verdict, Not(HasSubstr("not periodic: it does not come back to what it did")));
}

TEST(PathRhythm, MovementBelowTheNoiseHasNoEvents) {
  const auto still =
      rhythm_of(testing::recording_of(SeriesMatrix::Zero(300, 3), 100.0, 1e-3, 1), {.refits = 0});
  EXPECT_THAT(still.verdict, HasSubstr("moves by less than half the noise: no events"));
  EXPECT_THAT(rhythm_of(reaches(), {.refits = 0}).verdict, Not(HasSubstr("the noise: no events")));
}

TEST(PathRhythm, DeviationsCoverTheTruth) {
  int covered = 0, all = 0;
  for (std::uint64_t seed = 100; seed < 112; ++seed) {
    const auto found = rhythm_of(reaches(1e-3, seed), {.refits = 59, .seed = seed});
    for (const auto& event : found.events) {
      if (event.kind == PathEventKind::cycle_start) continue;
      const double share = event.kind == PathEventKind::movement_start ? kOnset : 1.0 - kOnset;
      const double since = event.time_s - kRest_s - share * kWay_s, round = kWay_s + kRest_s;
      ++all;
      covered += std::abs(since - round * std::round(since / round)) < 1.96 * event.sd_s;
    }
  }
  EXPECT_GE(all, 12 * 12 - 4);
  EXPECT_GE(covered, static_cast<int>(0.88 * all));
}

}  // namespace
}  // namespace kinemark::analysis
