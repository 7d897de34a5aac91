// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/trajectory/smoothing/internal/cutoff.h"

namespace kinemark::trajectory::smoothing {
namespace {

TEST(Stretches, AreTheRunsBetweenGaps) {
  const Array<std::uint8_t> present{0, 1, 1, 0, 0, 1, 0, 1, 1, 1};
  const auto found = stretches(present);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].begin, 1);
  EXPECT_EQ(found[0].end, 3);
  EXPECT_EQ(found[1].length(), 1);
  EXPECT_EQ(found[2].end, 10);
  EXPECT_TRUE(stretches({}).empty());
  EXPECT_TRUE(stretches({0, 0}).empty());
}

TEST(Stretches, LongRecordingsAreSampledEvenly) {
  const auto all = sample_of({{0, 1000}, {2000, 3000}});
  EXPECT_EQ(all.size(), 2u);
  std::int64_t total = 0, last = 0;
  for (const Stretch& s : sample_of({{0, 400000}, {500000, 1000000}})) {
    EXPECT_GE(s.begin, last);
    last = s.end;
    total += s.length();
  }
  EXPECT_NEAR(static_cast<double>(total), 16384.0, 2048.0);
  EXPECT_GT(last, 850000);
}

TEST(Stretches, DifferencesAreExactForParabolasInside) {
  std::vector<double> x;
  for (int i = 0; i < 10; ++i) x.push_back(0.01 * i * 0.01 * i);
  const auto v = differences(x, 0.01);
  for (std::size_t i = 1; i < 9; ++i) EXPECT_NEAR(v[i], 0.02 * static_cast<double>(i), 1e-12);
  EXPECT_NEAR(v[0], 0.01, 1e-12);
  EXPECT_TRUE(std::isnan(differences({1.0}, 0.01)[0]));
  EXPECT_TRUE(differences({}, 0.01).empty());
}

TEST(Stretches, DifferencePowerIsTheGainOfASine) {
  std::vector<double> x;
  for (int i = 0; i < 1000; ++i) x.push_back(std::sin(2.0 * M_PI * 0.07 * i));
  double power = 0.0;
  const auto v = differences(x, 0.01);
  for (std::size_t i = 100; i < 900; ++i) power += v[i] * v[i] / 800.0;
  EXPECT_NEAR(power / 0.5 / difference_power(0.07, 0.01), 1.0, 0.01);
}

CutoffProblem hand_problem() {
  CutoffProblem problem;
  problem.rate_hz = 100.0;
  Random random(7, 7);
  for (int column = 0; column < 3; ++column) {
    auto& x = problem.columns.emplace_back();
    for (int i = 0; i < 1000; ++i)
      x.push_back(0.2 * std::sin(2.0 * M_PI * 0.015 * i + column) + 0.02 * std::sin(2.0 * M_PI * 0.05 * i) +
                  0.0005 * random.gaussian());
  }
  return problem;
}

TEST(Cutoff, BothRulesKeepTheMovementAndDropMostNoise) {
  const CutoffProblem problem = hand_problem();
  for (const double cutoff : {winter_cutoff_hz(problem), challis_cutoff_hz(problem)}) {
    EXPECT_GT(cutoff, 5.0);
    EXPECT_LT(cutoff, 20.0);
  }
}

TEST(Cutoff, SlowRecordingsHaveSlowCutoffs) {
  CutoffProblem problem = hand_problem();
  const double at_100_hz = winter_cutoff_hz(problem);
  problem.rate_hz = 1.0;
  EXPECT_NEAR(winter_cutoff_hz(problem) / (0.01 * at_100_hz), 1.0, 0.1);
}

TEST(Cutoff, CorrectionRaisesWhatPasses) {
  std::vector<double> corrected, plain;
  for (int i = 0; i < 1000; ++i) corrected.push_back(std::sin(2.0 * M_PI * 0.06 * i));
  plain = corrected;
  butterworth(corrected, 2, 6.0, 100.0, true);
  butterworth(plain, 2, 6.0, 100.0, false);
  double c = 0.0, p = 0.0;
  for (std::size_t i = 300; i < 700; ++i) {
    c += corrected[i] * corrected[i] / 200.0;
    p += plain[i] * plain[i] / 200.0;
  }
  EXPECT_NEAR(std::sqrt(c), std::sqrt(0.5), 0.005);
  EXPECT_NEAR(std::sqrt(p), 0.5, 0.005);
}

using data::SampleState;
using data::Trajectories;

Trajectories two_markers(int frames) {
  auto t = Trajectories::all_missing({"A", "B"}, {50.0, 1.0, frames});
  for (int f = 0; f < frames; ++f) {
    for (int m = 0; m < 2; ++m) {
      t.x(f, m) = Eigen::Vector3d(f, 10.0 * m, 0.5);
      t.state[t.index(f, m)] = SampleState::measured;
    }
  }
  return t;
}

void set_variances(Trajectories& t, double v) {
  t.covariance.assign(6 * t.state.size(), 0.0);
  for (std::size_t i = 0; i < t.state.size(); ++i)
    for (const std::size_t d : math::kSymmetric3Diagonal) t.covariance[6 * i + d] = v;
}

TEST(MarkerSamples, TakesOneMarker) {
  auto t = two_markers(30);
  t.set_missing(4, 1);
  t.set_missing(5, 1, SampleState::rejected);
  const auto s = marker_samples(t, 1).value();
  EXPECT_EQ(s.frames, 30);
  EXPECT_EQ(s.measured, 28);
  EXPECT_EQ(s.interval_s, 0.02);
  EXPECT_EQ(s.x[3 * 7], 7.0);
  EXPECT_EQ(s.x[3 * 7 + 1], 10.0);
  EXPECT_EQ(s.present[4] + s.present[5], 0);
  EXPECT_FALSE(s.has_covariance);
  EXPECT_TRUE(s.variance.empty());
  std::vector<Array<double>> columns;
  const auto series = s.series(s.present, columns);
  ASSERT_EQ(series.size(), 1u);
  EXPECT_EQ(series[0].axes, 3);
  EXPECT_EQ(series[0].variance, nullptr);
  EXPECT_EQ(series[0].time_s, nullptr);
}

TEST(MarkerSamples, VariancesAreRelativeToTheMedian) {
  auto t = two_markers(30);
  set_variances(t, 4e-6);
  auto s = marker_samples(t, 0).value();
  EXPECT_TRUE(s.has_covariance);
  EXPECT_NEAR(s.typical_sd_m, 0.002, 1e-12);
  EXPECT_TRUE(s.variance.empty());  // all the same
  for (const std::size_t d : math::kSymmetric3Diagonal) t.covariance[6 * t.index(3, 0) + d] = 4e-5;
  s = marker_samples(t, 0).value();
  EXPECT_TRUE(s.same_for_all_axes);
  EXPECT_NEAR(s.variance[3], 10.0, 1e-9);
  EXPECT_NEAR(s.variance[30 + 3], 10.0, 1e-9);
}

TEST(MarkerSamples, AxesPartWhereVariancesDiffer) {
  auto t = two_markers(30);
  set_variances(t, 1e-6);
  for (int f = 0; f < 30; ++f) t.covariance[6 * t.index(f, 0) + 5] = 9e-6;
  const auto s = marker_samples(t, 0).value();
  EXPECT_FALSE(s.same_for_all_axes);
  std::vector<Array<double>> columns;
  const auto series = s.series(s.present, columns);
  ASSERT_EQ(series.size(), 3u);
  EXPECT_EQ(series[2].axes, 1);
  EXPECT_NEAR(series[2].variance[12] / series[0].variance[12], 9.0, 1e-9);
  EXPECT_EQ(series[0].y[12], 12.0);
  EXPECT_EQ(series[2].y[12], 0.5);
}

TEST(MarkerSamples, FilledStretchesWeighAsOneSampleAndDoNotJudge) {
  auto t = two_markers(40);
  for (int f = 10; f < 18; ++f) t.state[t.index(f, 0)] = SampleState::interpolated;
  t.state[t.index(25, 0)] = SampleState::model_filled;
  const auto s = marker_samples(t, 0).value();
  EXPECT_EQ(s.measured, 31);
  EXPECT_EQ(s.present[12], 1);
  EXPECT_EQ(s.judged[12], 0);
  ASSERT_FALSE(s.variance.empty());
  EXPECT_EQ(s.variance[12], 8.0);
  EXPECT_EQ(s.variance[40 + 12], 8.0);
  EXPECT_EQ(s.variance[25], 1.0);
  EXPECT_EQ(s.variance[5], 1.0);
}

TEST(MarkerSamples, TooFewMeasuredOnesAreJudgedWithTheRest) {
  auto t = two_markers(40);
  for (int f = 0; f < 35; ++f) t.state[t.index(f, 0)] = SampleState::upsampled;
  const auto s = marker_samples(t, 0).value();
  EXPECT_EQ(s.measured, 5);
  EXPECT_EQ(s.judged, s.present);
}

TEST(MarkerSamples, TimesOfEachFrame) {
  auto t = two_markers(30);
  t.sample_offset_s.assign(60, 0.003);  // the same in every frame: even
  EXPECT_TRUE(marker_samples(t, 0)->time_s.empty());
  t.sample_offset_s[t.index(10, 0)] = 0.008;
  t.set_missing(20, 0);
  t.set_missing(21, 0);
  t.sample_offset_s[t.index(20, 0)] = 99.0;  // of a frame without a sample: not used
  const auto s = marker_samples(t, 0).value();
  ASSERT_EQ(s.time_s.size(), 30u);
  EXPECT_NEAR(s.time_s[10], 0.208, 1e-12);
  for (std::size_t f = 1; f < 30; ++f) EXPECT_GT(s.time_s[f], s.time_s[f - 1]) << f;
  EXPECT_TRUE(marker_samples(t, 1)->time_s.empty());
  t.sample_offset_s[t.index(5, 1)] = std::nan("");
  EXPECT_FALSE(marker_samples(t, 1));
  t.sample_offset_s = {0.001, HUGE_VAL};
  EXPECT_TRUE(marker_samples(t, 0));
  ASSERT_FALSE(marker_samples(t, 1));
  EXPECT_THAT(marker_samples(t, 1).error().message, ::testing::HasSubstr("'B'"));
}

}  // namespace

}  // namespace kinemark::trajectory::smoothing
