// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/scalar_function.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace kinemark::math {
namespace {

const std::vector<double> kX{-2.0944,   -1.74533, -1.39626, -1.0472,  -0.698132, -0.349066,
                             -0.174533, 0.197344, 0.337395, 0.490178, 1.52146,   2.0944};
const std::vector<double> kY{-0.0032, 0.00179,   0.00411,   0.0041,    0.00212,   -0.001,
                             -0.0031, -0.005227, -0.005435, -0.005574, -0.005435, -0.00525};

std::vector<ScalarFunction> every_kind() {
  return {ScalarFunction(),
          ScalarFunction::constant(3.0),
          ScalarFunction::linear(-2.0, 0.5),
          ScalarFunction::polynomial({0.1, -0.2, 0.3, 0.4, -0.05}),
          ScalarFunction::sine(0.3, 2.0, 0.4, -1.0),
          ScalarFunction::simm_spline(kX, kY).value(),
          ScalarFunction::natural_spline(kX, kY).value(),
          ScalarFunction::piecewise_linear(kX, kY).value(),
          ScalarFunction::simm_spline(kX, kY)->scaled(1.7)};
}

TEST(ScalarFunction, DerivativesMatchCentralDifferences) {
  const double step = 1e-5;
  for (const auto& f : every_kind()) {
    for (double x = -2.6; x < 2.6; x += 0.0837) {
      const bool at_a_knot =
          std::any_of(kX.begin(), kX.end(), [&](double k) { return std::abs(k - x) < 2 * step; });
      if (at_a_knot) continue;
      EXPECT_NEAR(f(x).df, (f(x + step).f - f(x - step).f) / (2 * step), 1e-8) << x;
      EXPECT_NEAR(f(x).ddf, (f(x + step).df - f(x - step).df) / (2 * step), 1e-7) << x;
    }
  }
}

TEST(ScalarFunction, SplinesPassThroughTheirKnots) {
  for (const auto& f :
       {ScalarFunction::simm_spline(kX, kY).value(), ScalarFunction::natural_spline(kX, kY).value(),
        ScalarFunction::piecewise_linear(kX, kY).value()})
    for (std::size_t i = 0; i < kX.size(); ++i) EXPECT_NEAR(f(kX[i]).f, kY[i], 1e-15);
}

TEST(SimmSpline, ReproducesACubicExactlyBecauseOfItsEndConditions) {
  std::vector<double> x{-1.0, -0.3, 0.1, 0.8, 1.5, 2.0}, y;
  const auto cubic = [](double t) { return 0.4 - 1.1 * t + 0.7 * t * t - 0.3 * t * t * t; };
  for (const double t : x) y.push_back(cubic(t));
  const auto f = ScalarFunction::simm_spline(x, y).value();
  for (double t = -1.0; t <= 2.0; t += 0.01) EXPECT_NEAR(f(t).f, cubic(t), 1e-13);
  // A natural spline cannot: this distinguishes the two.
  const auto natural = ScalarFunction::natural_spline(x, y).value();
  EXPECT_GT(std::abs(natural(-0.7).f - cubic(-0.7)), 1e-3);
}

TEST(SimmSpline, IsLinearBeyondTheKnotsWithTheEndSlope) {
  const auto f = ScalarFunction::simm_spline(kX, kY).value();
  for (const double outside : {-3.0, 3.0}) {
    const double end = outside < 0 ? kX.front() : kX.back();
    EXPECT_NEAR(f(outside).f, f(end).f + (outside - end) * f(end).df, 1e-15);
    EXPECT_EQ(f(outside).ddf, 0.0);
    EXPECT_EQ(f(outside).df, f(end).df);
  }
}

TEST(SimmSpline, TwoAndThreePointsAreSimple) {
  const auto line = ScalarFunction::simm_spline({0.0, 2.0}, {1.0, 5.0}).value();
  EXPECT_DOUBLE_EQ(line(1.0).f, 3.0);
  EXPECT_DOUBLE_EQ(line(-1.0).f, -1.0);
  const auto parabola = ScalarFunction::simm_spline({0.0, 1.0, 2.0}, {0.0, 1.0, 4.0}).value();
  EXPECT_NEAR(parabola(0.5).f, 0.25, 1e-14);  // three points, zero third derivative: the parabola itself
}

TEST(ScalarFunction, RefusesBadKnotsInOneSentence) {
  EXPECT_THAT(ScalarFunction::simm_spline({0, 1}, {0}).error().message, testing::HasSubstr("2 x and 1 y"));
  EXPECT_THAT(ScalarFunction::simm_spline({0}, {0}).error().message, testing::HasSubstr("two or more"));
  EXPECT_THAT(ScalarFunction::simm_spline({0, 0}, {0, 1}).error().message,
              testing::HasSubstr("must increase"));
  EXPECT_THAT(ScalarFunction::simm_spline({0, NAN}, {0, 1}).error().message, testing::HasSubstr("finite"));
}

TEST(ScalarFunction, KnowsWhatItIs) {
  EXPECT_TRUE(ScalarFunction().is_identity());
  EXPECT_FALSE(ScalarFunction().scaled(2.0).is_identity());
  EXPECT_TRUE(ScalarFunction::linear(2, 1).is_linear());
  EXPECT_EQ(ScalarFunction::linear(2, 1).scaled(3.0).slope(), 6.0);
  EXPECT_EQ(ScalarFunction::linear(2, 1).scaled(3.0).offset(), 3.0);
  EXPECT_TRUE(ScalarFunction::constant(1).is_constant());
  EXPECT_FALSE(ScalarFunction::sine(1, 1, 0, 0).is_linear());
}

}  // namespace
}  // namespace kinemark::math
