// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/internal/interpolation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::trajectory::internal {
namespace {

using data::InterpolationKernel;

/// Largest residual over the frames that are predicted, and how many those are.
std::pair<double, int> worst(const std::vector<double>& y, int factor, int phase,
                             InterpolationKernel kernel) {
  Knots knots;
  std::vector<double> out(y.size());
  EXPECT_TRUE(residuals(y, factor, phase, kernel, knots, out));
  std::pair<double, int> result{0.0, 0};
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i] == kNotPredicted) continue;
    result.first = std::max(result.first, std::abs(out[i]));
    ++result.second;
    EXPECT_NE(static_cast<int>(i) % factor, phase);
  }
  return result;
}

std::vector<double> sampled(int n, double (*f)(double)) {
  std::vector<double> y;
  for (int i = 0; i < n; ++i) y.push_back(f(0.01 * i));
  return y;
}

TEST(Residuals, EachKernelReproducesThePolynomialsItShould) {
  const auto line = sampled(400, [](double x) { return 3.0 - 2.0 * x; });
  const auto parabola = sampled(400, [](double x) { return 1.0 + x - 4.0 * x * x; });
  const auto cubic = sampled(400, [](double x) { return x * x * x - 2.0 * x * x; });
  for (const InterpolationKernel k :
       {InterpolationKernel::linear, InterpolationKernel::spline, InterpolationKernel::catmull_rom,
        InterpolationKernel::lagrange, InterpolationKernel::pchip, InterpolationKernel::akima})
    EXPECT_LT(worst(line, 4, 1, k).first, 1e-12) << to_string(k);
  EXPECT_NEAR(worst(line, 4, 1, InterpolationKernel::hold).first, 0.06, 1e-9);
  for (const InterpolationKernel k :
       {InterpolationKernel::catmull_rom, InterpolationKernel::lagrange, InterpolationKernel::akima})
    EXPECT_LT(worst(parabola, 4, 1, k).first, 1e-12) << to_string(k);
  EXPECT_LT(worst(cubic, 4, 1, InterpolationKernel::lagrange).first, 1e-12);
  // A natural spline is wrong at the ends only, by 0.27 per knot inwards: 8 knots in, little is left.
  EXPECT_LT(worst(cubic, 4, 1, InterpolationKernel::spline).first, 1e-6);
  EXPECT_GT(worst(cubic, 4, 1, InterpolationKernel::catmull_rom).first, 1e-7);
  EXPECT_GT(worst(parabola, 4, 1, InterpolationKernel::linear).first, 1e-3);
}

TEST(Residuals, LagrangeAndCatmullRomAreOneFormulaAtFactorTwo) {
  Random random(1, 1);
  std::vector<double> y(200);
  for (double& v : y) v = random.gaussian();
  Knots knots;
  std::vector<double> a(y.size());
  std::vector<double> b(y.size());
  ASSERT_TRUE(residuals(y, 2, 0, InterpolationKernel::lagrange, knots, a));
  ASSERT_TRUE(residuals(y, 2, 0, InterpolationKernel::catmull_rom, knots, b));
  for (std::size_t i = 0; i < y.size(); ++i)
    if (a[i] != kNotPredicted) {
      EXPECT_NEAR(a[i], b[i], 1e-12);
    }
}

TEST(Residuals, PchipDoesNotOvershoot) {
  Random random(2, 1);
  std::vector<double> y(400);
  for (double& v : y) v = random.gaussian();
  Knots knots;
  std::vector<double> out(y.size());
  ASSERT_TRUE(residuals(y, 4, 0, InterpolationKernel::pchip, knots, out));
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (out[i] == kNotPredicted) continue;
    const double made = y[i] - out[i];
    const std::size_t left = i / 4 * 4;
    EXPECT_GE(made, std::min(y[left], y[left + 4]) - 1e-12);
    EXPECT_LE(made, std::max(y[left], y[left + 4]) + 1e-12);
  }
}

TEST(Residuals, LeavesOutTheEndsAndRefusesShortStretches) {
  const std::vector<double> y(100, 1.0);
  // Knots 0, 4, ..., 96: 25 of them. Intervals from the third to the third last knot, three frames in each.
  EXPECT_EQ(worst(y, 4, 0, InterpolationKernel::linear).second, 3 * (25 - 5));
  EXPECT_EQ(worst(y, 4, 0, InterpolationKernel::spline).second, 3 * (25 - 17));
  Knots knots;
  std::vector<double> out(30);
  EXPECT_FALSE(residuals(std::vector<double>(30, 1.0), 4, 0, InterpolationKernel::linear, knots, out));
  EXPECT_FALSE(residuals(std::vector<double>(30, 1.0), 4, 3, InterpolationKernel::spline, knots, out));
  std::vector<double> none;
  EXPECT_FALSE(residuals({}, 2, 1, InterpolationKernel::hold, knots, none));
}

}  // namespace
}  // namespace kinemark::trajectory::internal
