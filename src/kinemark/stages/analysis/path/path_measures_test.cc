// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/path_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/low_pass.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis {
namespace {

using data::IntervalKind;

const data::Measure& find(const PathMeasures& measures, std::string_view id) {
  const auto found = std::ranges::find(measures.measures, id, &data::Measure::id);
  if (found == measures.measures.end()) throw std::runtime_error("no measure " + std::string(id));
  return *found;
}

bool has(const PathMeasures& measures, std::string_view id) {
  return std::ranges::find(measures.measures, id, &data::Measure::id) != measures.measures.end();
}

data::Trajectories reach(double noise_m = 5e-4, std::uint64_t seed = 1) {
  return testing::recording_of(testing::sampled(170, 100.0, testing::reach), 100.0, noise_m, seed);
}

TEST(MeasurePaths, OfAReachComeWithTheTruthInTheirIntervals) {
  const auto found = measure_paths(reach(), {.refits = 59});
  ASSERT_TRUE(found) << found.error().message;
  for (const auto& measure : found->measures) EXPECT_TRUE(measure.validate()) << measure.id;
  // A straight reach of 0.304 m in 0.7 s.
  const double way = std::hypot(0.3, 0.05);
  const auto& peak = find(*found, "peak_speed");
  EXPECT_NEAR(peak.value, 1.875 * way / 0.7, 0.02);
  EXPECT_LT(peak.interval.low, 1.875 * way / 0.7);
  EXPECT_GT(peak.interval.high, 1.875 * way / 0.7);
  const double onset = 0.5 + 0.7 * (0.5 - std::sqrt(0.25 - std::sqrt(0.003125)));
  EXPECT_NEAR(find(*found, "onset").value, onset, 0.01);
  EXPECT_EQ(find(*found, "submovements").value, 1.0);
  EXPECT_EQ(find(*found, "path_length").interval.kind, IntervalKind::at_most);
  EXPECT_GT(find(*found, "path_length").interval.high, way);
  EXPECT_EQ(find(*found, "plane_sd").interval.kind, IntervalKind::at_most);
  EXPECT_FALSE(has(*found, "cycle_time"));
}

TEST(MeasurePaths, OfCyclesAreThoseOfTheEllipse) {
  const auto markers = testing::recording_of(testing::sampled(400, 100.0, testing::ellipse), 100.0, 1e-3, 2);
  const auto found = measure_paths(markers, {.refits = 39});
  ASSERT_TRUE(found);
  EXPECT_NEAR(find(*found, "ellipse_major").value, 0.4, 1e-3);
  EXPECT_NEAR(find(*found, "ellipse_minor").value, 0.2, 1e-3);
  EXPECT_NEAR(find(*found, "cycle_time").value, 1.0, 3e-3);
  EXPECT_NEAR(find(*found, "power_law_exponent").value, 1.0 / 3.0, 0.03);
  EXPECT_FALSE(has(*found, "onset"));
}

TEST(MeasurePaths, HoldWhatTheCalibrationLeavesUnknown) {
  const auto markers = testing::recording_of(testing::sampled(400, 100.0, testing::ellipse), 100.0, 1e-4, 2);
  PathMeasureOptions options{.measures = {"ellipse_major", "cycle_time"}, .refits = 99};
  const auto noise_alone = measure_paths(markers, options);
  // The room may be larger by 1 %: terms 1, z, ..., x of the polynomial.
  data::CalibrationError::Field larger = data::CalibrationError::Field::Zero();
  larger(1, 2) = larger(4, 1) = larger(10, 0) = 0.01;
  options.calibration_error.fields = {larger};
  const auto both = measure_paths(markers, options);
  ASSERT_TRUE(noise_alone && both);
  EXPECT_LT(find(*noise_alone, "ellipse_major").sd, 1e-4);
  EXPECT_NEAR(find(*both, "ellipse_major").sd, 0.01 * 0.4, 0.001);
  EXPECT_NEAR(find(*both, "ellipse_major").interval.low, 0.4 * (1.0 - 1.96 * 0.01), 0.004);
  // Times do not depend on the room.
  EXPECT_LT(find(*both, "cycle_time").sd, 1.2 * find(*noise_alone, "cycle_time").sd);
}

TEST(MeasurePaths, AreTheSameForAnyNumberOfThreadsAndWhateverElseIsMeasured) {
  const auto one = reach(5e-4, 1), other = reach(5e-4, 9);
  auto both = data::Trajectories::all_missing({"A", "B"}, one.time);
  for (std::int64_t f = 0; f < one.frames(); ++f)
    for (int m = 0; m < 2; ++m) {
      both.x(f, m) = (m == 0 ? one : other).x(f, 0);
      both.state[both.index(f, m)] = data::SampleState::measured;
    }
  const auto single = measure_paths(both, {.refits = 39, .threads = 1});
  const auto threaded = measure_paths(both, {.refits = 39, .threads = 2});
  const auto alone = measure_paths(both, {.measures = {"peak_speed"}, .refits = 39, .threads = 2});
  ASSERT_TRUE(single && threaded && alone);
  ASSERT_EQ(single->measures.size(), threaded->measures.size());
  for (std::size_t i = 0; i < single->measures.size(); ++i) {
    EXPECT_EQ(single->measures[i].id, threaded->measures[i].id);
    if (std::isfinite(single->measures[i].value)) {
      EXPECT_EQ(single->measures[i].value, threaded->measures[i].value);
    }
  }
  ASSERT_EQ(alone->measures.size(), 2u);
  EXPECT_EQ(find(*alone, "peak_speed").interval.high, find(*single, "peak_speed").interval.high);
  EXPECT_EQ(alone->measures[1].subject, "B");
}

TEST(MeasurePaths, OfARegionAreItsOwn) {
  const auto found = measure_paths(reach(), {.measures = {"mean_speed", "path_length"},
                                             .regions = {{"rest", 10, 40}, {"reach", 50, 120}},
                                             .refits = 0});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->measures.size(), 4u);
  EXPECT_EQ(found->measures[0].region, "rest");
  EXPECT_NEAR(found->measures[2].value, 0.304, 0.003);
  EXPECT_EQ(found->measures[2].region, "reach");
  EXPECT_NEAR(found->measures[2].start_s, 0.5, 1e-9);
  EXPECT_NEAR(found->measures[2].end_s, 1.2, 1e-9);
}

TEST(MeasurePaths, MeanSpeedTimesTheTimeIsThePath) {
  // From rest to the largest speed: the two ends weigh half a step each.
  const auto found = measure_paths(
      reach(), {.measures = {"path_length", "mean_speed"}, .regions = {{"half", 55, 85}}, .refits = 0});
  ASSERT_TRUE(found);
  const auto& path = find(*found, "path_length");
  EXPECT_NEAR(find(*found, "mean_speed").value * (path.end_s - path.start_s), path.value, 2e-3 * path.value);
}

TEST(MeasurePaths, ShareOfWhatWasNotMeasuredIsReported) {
  auto markers = reach();
  for (std::int64_t f = 60; f < 75; ++f) markers.set_missing(f, 0);
  for (std::int64_t f = 75; f < 80; ++f) markers.state[markers.index(f, 0)] = data::SampleState::interpolated;
  const auto found = measure_paths(markers, {.measures = {"peak_speed"}, .refits = 39});
  ASSERT_TRUE(found);
  const auto& peak = found->measures.front();
  EXPECT_NEAR(peak.share_not_measured, 20.0 / 154.0, 1e-9);  // without the edges of 8 samples
  EXPECT_EQ(peak.interval.kind, IntervalKind::two_sided);
  for (std::int64_t f = 80; f < 84; ++f) markers.set_missing(f, 0);
  const auto longer = measure_paths(markers, {.measures = {"peak_speed"}, .refits = 39});
  EXPECT_EQ(longer->measures.front().interval.kind, IntervalKind::none);
  EXPECT_NE(longer->measures.front().remark.find("gap of 0.24 s"), std::string::npos);
}

TEST(MeasurePaths, MovementBelowTheNoiseHasNoInterval) {
  const auto still = [](double t) {
    return Eigen::Vector3d(2e-4 * std::sin(testing::kTurn * 6.0 * t), 0.0, 0.01 * t);
  };
  const auto markers = testing::recording_of(testing::sampled(500, 100.0, still), 100.0, 1e-3, 4);
  const auto found = measure_paths(markers, {.measures = {"peak_speed", "tremor"}, .refits = 39});
  ASSERT_TRUE(found);
  EXPECT_EQ(find(*found, "peak_speed").interval.kind, IntervalKind::none);
  EXPECT_NE(find(*found, "peak_speed").remark.find("below half the noise"), std::string::npos);
  EXPECT_GT(find(*found, "tremor").interval.high, std::sqrt(0.5) * 2e-4);
}

TEST(MeasurePaths, NoiseThatDisagreesIsReported) {
  const auto agrees =
      measure_paths(reach(1e-3), {.measures = {"peak_speed"}, .refits = 0, .noise_sd_m = 1e-3});
  ASSERT_TRUE(agrees);
  EXPECT_TRUE(agrees->warnings.empty());
  const auto not_so =
      measure_paths(reach(1e-3), {.measures = {"peak_speed"}, .refits = 0, .noise_sd_m = 5e-4});
  ASSERT_EQ(not_so->warnings.size(), 1u);
  EXPECT_NE(not_so->warnings[0].find("not the 0.5 mm that were stated"), std::string::npos)
      << not_so->warnings[0];
}

// Four seconds of cycles with noise of a model, through its filter where it has one.
data::Trajectories ellipses_with(const math::NoiseModel& model, std::uint64_t seed, bool through = true) {
  SeriesMatrix x =
      testing::sampled(400, 100.0, testing::ellipse) + noise_before_filter(model, 400, 3, seed, 4);
  if (model.order > 0 && through) LowPassFilter(model, 400).apply(x);
  for (auto& value : x.reshaped()) value = 1e-3 * static_cast<double>(static_cast<float>(1e3 * value));
  return testing::recording_of(x, 100.0, 0.0, 1);
}
const math::NoiseModel kQuintic{.kind = math::NoiseKind::filtered,
                                .form = math::LowPass::spline,
                                .order = 3,
                                .variance = 2.5e-7,
                                .half = 0.08};

TEST(MeasurePaths, OfAFilteredRecordingHaveIntervalsOfTheNoiseBefore) {
  const auto found =
      measure_paths(ellipses_with(kQuintic, 2), {.measures = {"path_length", "peak_acceleration", "tremor"}});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->noises.size(), 1u);
  EXPECT_TRUE(found->noises[0].filtered());
  ASSERT_FALSE(found->warnings.empty());
  EXPECT_NE(found->warnings[0].find("P: the noise is not white, its spectrum falls as behind a low-pass at"),
            std::string::npos)
      << found->warnings[0];
  // The way by a fine sum; what the eye takes for noise, the rounding, would give a thousandth of this width.
  const auto& path = find(*found, "path_length");
  double truth = 0.0;
  constexpr int kSteps = 100000;
  const auto place = [&path](int i) {
    return testing::ellipse(path.start_s + (path.end_s - path.start_s) * i / kSteps);
  };
  for (int i = 0; i < kSteps; ++i) truth += (place(i + 1) - place(i)).norm();
  EXPECT_LT(path.interval.low, truth);
  EXPECT_GT(path.interval.high, truth);
  EXPECT_GT(path.interval.high - path.interval.low, 2e-4);
  const auto& tremor = find(*found, "tremor");
  EXPECT_EQ(tremor.interval.kind, IntervalKind::at_least);
  EXPECT_NE(tremor.remark.find("falls as behind a low-pass at"), std::string::npos);
}

TEST(MeasurePaths, SamplesFromBeforeAFilterAreWhatIsMeasured) {
  const auto raw = ellipses_with(kQuintic, 3, false);
  auto both = ellipses_with(kQuintic, 3);
  both.filters.assign(1, {.method = "kalman", .order = 3, .cutoff_hz = 7.0, .noise_sd_m = 5e-4});
  both.unfiltered_in_world = raw.x_in_world;
  const PathMeasureOptions options{.refits = 39};
  const auto before = measure_paths(raw, options), after = measure_paths(both, options);
  ASSERT_TRUE(before && after);
  ASSERT_EQ(before->measures.size(), after->measures.size());
  for (std::size_t i = 0; i < before->measures.size(); ++i)
    if (std::isfinite(before->measures[i].value)) {
      EXPECT_EQ(before->measures[i].value, after->measures[i].value) << before->measures[i].id;
    }
  // The filter alone is taken at its word.
  both.unfiltered_in_world = {};
  const auto stated = measure_paths(both, options);
  ASSERT_TRUE(stated);
  EXPECT_EQ(stated->noises[0].source, NoiseSource::filter);
  EXPECT_NEAR(stated->noises[0].cutoff_hz.middle, 7.0, 0.4);
}

TEST(MeasurePaths, SlowNoiseTakesTheIntervalsOfWhatRestsOnItAndNoOthers) {
  const math::NoiseModel slow{.kind = math::NoiseKind::correlated, .variance = 1e-6, .correlation = 0.99};
  const PathMeasureOptions options{
      .measures = {"extent_long", "largest_distance", "plane_sd", "path_length", "peak_speed"}};
  const auto found = measure_paths(ellipses_with(slow, 3), options);
  ASSERT_TRUE(found);
  for (const char* id : {"extent_long", "largest_distance", "plane_sd"}) {
    EXPECT_EQ(find(*found, id).interval.kind, IntervalKind::none) << id;
    EXPECT_NE(find(*found, id).remark.find("cannot be distinguished from movement"), std::string::npos) << id;
  }
  EXPECT_EQ(find(*found, "path_length").interval.kind, IntervalKind::two_sided);
  EXPECT_EQ(find(*found, "peak_speed").interval.kind, IntervalKind::two_sided);
  const auto white = measure_paths(ellipses_with({.variance = 1e-6}, 3), options);
  ASSERT_TRUE(white);
  EXPECT_EQ(find(*white, "extent_long").interval.kind, IntervalKind::two_sided);
  EXPECT_TRUE(white->warnings.empty());
}

TEST(MeasurePaths, WhatCannotBeMeasuredIsReportedAndTheOthersAre) {
  const auto one = reach();
  auto both = data::Trajectories::all_missing({"P", "SELDOM"}, one.time);
  for (std::int64_t f = 0; f < one.frames(); ++f) {
    both.x(f, 0) = one.x(f, 0);
    both.state[both.index(f, 0)] = data::SampleState::measured;
    if (f >= 29) continue;
    both.x(f, 1) = one.x(f, 0);
    both.state[both.index(f, 1)] = data::SampleState::measured;
  }
  const auto found = measure_paths(
      both, {.measures = {"peak_speed"}, .regions = {{"all", 0, 169}, {"blink", 50, 52}}, .refits = 0});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->measures.size(), 1u);
  ASSERT_EQ(found->warnings.size(), 2u);
  EXPECT_EQ(found->warnings[0], "SELDOM was measured in 29 frames; need 30 at least");
  EXPECT_EQ(found->warnings[1], "P in region 'blink': 3 frames without the edges of 80 ms; need 5 at least");
}

TEST(MeasurePaths, RefuseWhatMakesNoSense) {
  const auto says = [](const data::Trajectories& markers, const PathMeasureOptions& options) {
    const auto found = measure_paths(markers, options);
    return found ? std::string() : found.error().message;
  };
  EXPECT_EQ(says(reach(), {.measures = {"path_lenght"}}),
            "there is no measure 'path_lenght' (nearest: path_length); --list shows them all");
  EXPECT_EQ(says(reach(), {.refits = 10}),
            "10 refits; need 0 (no intervals) or at least 39 for intervals of level 0.95");
  EXPECT_EQ(says(reach(), {.level = 0.99}),
            "99 refits; need 0 (no intervals) or at least 199 for intervals of level 0.99");
  EXPECT_EQ(says(reach(), {.level = 1.0}), "intervals of level 1; need one above 0.5 and at most 0.9999");
  EXPECT_EQ(says(reach(), {.regions = {{"back", 100, 50}}}),
            "region 'back' ends in frame 50, before it begins in frame 100");
  EXPECT_NE(says(reach(), {.regions = {{"late", 500, 600}}}).find("lies outside the recording"),
            std::string::npos);
  auto without_rate = reach();
  without_rate.time.rate_hz = 0.0;
  EXPECT_NE(says(without_rate, {}).find("no frame rate"), std::string::npos);
  EXPECT_NE(says(data::Trajectories::all_missing({}, {.rate_hz = 100.0, .frames = 5}), {}).find("no markers"),
            std::string::npos);
}

}  // namespace
}  // namespace kinemark::analysis
