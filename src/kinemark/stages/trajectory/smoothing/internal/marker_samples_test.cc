// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/math/symmetric3.h"

namespace kinemark::trajectory::smoothing {
namespace {

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
