// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/low_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kinemark::analysis {
namespace {

using math::LowPass;
using math::NoiseKind;
using math::NoiseModel;
using math::SeriesMatrix;

SeriesMatrix wave(std::int64_t n, double frequency) {
  SeriesMatrix out(n, 1);
  const std::int64_t middle = n / 2;
  for (std::int64_t i = 0; i < n; ++i)
    out(i, 0) = std::cos(2.0 * std::numbers::pi * frequency * static_cast<double>(i - middle));
  return out;
}

TEST(LowPassFilter, LeavesOfAWaveWhatItsGainSays) {
  for (const auto form : {LowPass::butterworth, LowPass::spline})
    for (const int order : {2, 4}) {
      const NoiseModel model{.kind = NoiseKind::filtered, .form = form, .order = order, .half = 0.08};
      for (const double f : {0.02, 0.08, 0.15}) {
        SeriesMatrix x = wave(1001, f);
        LowPassFilter(model, 1001).apply(x);
        EXPECT_NEAR(x(500, 0), model.gain(f), 1e-4) << order << " " << f;
      }
    }
}

TEST(LowPassFilter, FarBelowTheRateASplineIsButterworths) {
  const NoiseModel model{.kind = NoiseKind::filtered, .form = LowPass::spline, .order = 5, .half = 0.003};
  SeriesMatrix x = wave(4001, 0.003);
  LowPassFilter(model, 4001).apply(x);
  EXPECT_NEAR(x(2000, 0), 0.5, 0.01);
}

TEST(NoiseBeforeFilter, HasTheVarianceAndTheCorrelationOfItsModel) {
  const NoiseModel model{.kind = NoiseKind::correlated, .variance = 4e-6, .correlation = 0.9};
  const auto noise = noise_before_filter(model, 20000, 3, 1, 2);
  EXPECT_NEAR(noise.squaredNorm() / 60000.0, 4e-6, 4e-7);
  const double next = noise.bottomRows(19999).cwiseProduct(noise.topRows(19999)).sum() / 59997.0;
  EXPECT_NEAR(next / 4e-6, 0.9, 0.1);
  EXPECT_EQ(noise, noise_before_filter(model, 20000, 3, 1, 2));
  EXPECT_NE(noise, noise_before_filter(model, 20000, 3, 1, 3));
}

TEST(AddFloor, AddsWhiteNoiseThatIsNotTheOther) {
  const NoiseModel model{
      .kind = NoiseKind::correlated_and_white, .variance = 1.0, .correlation = 0.5, .floor = 0.25};
  SeriesMatrix x = SeriesMatrix::Zero(20000, 3);
  add_floor(model, x, 1, 2, 1, 2);
  EXPECT_EQ(x.col(0).norm(), 0.0);
  EXPECT_NEAR(x.squaredNorm() / 40000.0, 0.25, 0.01);
  const auto other = noise_before_filter(model, 20000, 3, 1, 2);
  EXPECT_LT(std::abs(other.col(1).dot(x.col(1)) / (other.col(1).norm() * x.col(1).norm())), 0.03);
}

}  // namespace
}  // namespace kinemark::analysis
