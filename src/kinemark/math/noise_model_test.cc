// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/noise_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/math/difference_smoother.h"
#include "kinemark/math/digital_filter.h"

namespace kinemark::math {
namespace {

TEST(GainOf, ButterworthIsThatOfTheFilterRunBothWays) {
  for (const int order : {1, 2, 4}) {
    const double design = 0.07;
    const auto sections = butterworth_lowpass(order, design);
    for (const double f : {0.01, 0.05, 0.07, 0.1, 0.3}) {
      const double one_pass = amplitude(sections, f);
      EXPECT_NEAR(gain_of(LowPass::butterworth, order, design, f), one_pass * one_pass, 1e-9)
          << order << " " << f;
    }
    EXPECT_NEAR(three_db_of_half(LowPass::butterworth, order, design), two_pass_half_power(order, design),
                1e-9);
  }
}

TEST(GainOf, SplineIsThatOfTheSmoother) {
  const std::int64_t n = 2001, middle = n / 2;
  for (int order = 1; order <= 5; ++order)
    for (const double f : {0.03, 0.06, 0.12}) {
      DifferenceSmoother smoother(std::vector<bool>(n, true), order);
      ASSERT_TRUE(smoother.factor(0.06));
      SeriesMatrix wave(n, 1);
      for (std::int64_t i = 0; i < n; ++i)
        wave(i, 0) = std::cos(2.0 * std::numbers::pi * f * static_cast<double>(i - middle));
      smoother.smooth(wave);
      EXPECT_NEAR(wave(middle, 0), gain_of(LowPass::spline, order, 0.06, f), 1e-6) << order << " " << f;
    }
}

TEST(ThreeDb, AndHalfAreInverse) {
  for (const auto form : {LowPass::butterworth, LowPass::spline})
    for (int order = 1; order <= 4; ++order)
      for (const double half : {0.02, 0.1, 0.2}) {
        const double down = three_db_of_half(form, order, half);
        EXPECT_LT(down, half);
        EXPECT_NEAR(gain_of(form, order, half, down), std::sqrt(0.5), 1e-9);
        EXPECT_NEAR(half_of_three_db(form, order, down), half, 1e-9);
      }
}

TEST(NoiseModel, CorrelatedNoiseKeepsItsVarianceOverAllFrequencies) {
  const NoiseModel model{.kind = NoiseKind::correlated, .variance = 4.0, .correlation = 0.9};
  double sum = 0.0;
  for (int i = 0; i < 20000; ++i) sum += model.power(0.5 * (i + 0.5) / 20000) / 20000;
  EXPECT_NEAR(sum, 4.0, 1e-3);
  EXPECT_NEAR(model.power(0.0), 4.0 * 1.9 / 0.1, 1e-9);
  EXPECT_NEAR(model.sd(), 2.0, 1e-12);
}

TEST(NoiseModel, FilteredNoiseIsLessBehindTheFilterThanBefore) {
  const NoiseModel model{.kind = NoiseKind::filtered,
                         .form = LowPass::spline,
                         .order = 3,
                         .variance = 1.0,
                         .half = 0.06,
                         .floor = 1e-6};
  EXPECT_NEAR(model.power(1e-6), 1.0, 1e-5);
  EXPECT_NEAR(model.power(0.06), 0.25, 2e-3);
  EXPECT_NEAR(model.power(0.5), 1e-6, 1e-6);
  EXPECT_NEAR(model.sd(true), 1.0, 1e-5);
  // 2 fc (1 - 1/2m) (pi/2m) / sin(pi/2m) of the variance is left.
  const double pi = std::numbers::pi;
  EXPECT_NEAR(model.sd() * model.sd(), 2.0 * 0.06 * (5.0 / 6.0) * (pi / 6.0) / std::sin(pi / 6.0), 2e-3);
}

TEST(NameOf, SaysWhatLaboratoriesCallIt) {
  EXPECT_EQ(name_of(LowPass::spline, 3), "quintic spline");
  EXPECT_EQ(name_of(LowPass::butterworth, 2), "Butterworth filter of order 2, both ways");
  EXPECT_EQ(to_string(NoiseKind::filtered), "filtered");
  EXPECT_EQ(to_string(NoiseKind::correlated_and_white), "correlated and white");
}

}  // namespace
}  // namespace kinemark::math
