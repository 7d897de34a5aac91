// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/spline_undo.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::math {
namespace {

constexpr double kRate = 100.0;

/// Three axes of a movement of some hundred millimetres with 0.3 mm of noise, in mm.
SeriesMatrix recording(std::int64_t n, std::uint64_t seed) {
  Random random(seed, 0);
  SeriesMatrix y(n, 3);
  for (std::int64_t i = 0; i < n; ++i)
    for (int axis = 0; axis < 3; ++axis)
      y(i, axis) = 600.0 * std::sin(0.02 * static_cast<double>(i) + axis) + 0.3 * random.gaussian();
  return y;
}

SeriesMatrix smoothed(const SeriesMatrix& y, const std::vector<bool>& seen, int order, double half_power) {
  DifferenceSmoother smoother(seen, order);
  EXPECT_TRUE(smoother.factor(half_power));
  SeriesMatrix f = y;
  smoother.smooth(f);
  return f;
}

double rms(const SeriesMatrix& a, const SeriesMatrix& b, const std::vector<bool>& seen) {
  double sum = 0.0, count = 0.0;
  for (std::int64_t i = 0; i < a.rows(); ++i)
    if (seen[static_cast<std::size_t>(i)])
      sum += (a.row(i) - b.row(i)).squaredNorm(), count += static_cast<double>(a.cols());
  return std::sqrt(sum / count);
}

TEST(SplineUndo, GivesBackWhatWentIn) {
  const std::vector<bool> all(400, true);
  const auto y = recording(400, 1);
  for (int order = 1; order <= 4; ++order) {
    const double half = half_power_of(order, 8.0, kRate);
    const auto f = smoothed(y, all, order, half);
    ASSERT_GT(rms(f, y, all), 0.1) << "there is something to undo";
    const auto undone = undo_spline(f, all, order, half);
    ASSERT_TRUE(undone);
    EXPECT_LT(rms(undone->samples, y, all), 1e-4) << order;
    EXPECT_LT(undone->error_sd, 1e-4) << order;
  }
}

TEST(SplineUndo, AcrossGapsToo) {
  std::vector<bool> seen(300, true);
  for (const int i : {0, 40, 41, 42, 43, 44, 45, 120, 298, 299}) seen[static_cast<std::size_t>(i)] = false;
  const auto y = recording(300, 2);
  for (int order = 2; order <= 4; ++order) {
    const double half = half_power_of(order, 12.0, kRate);
    auto f = smoothed(y, seen, order, half);
    for (std::int64_t i = 0; i < 300; ++i)
      if (!seen[static_cast<std::size_t>(i)]) f.row(i).setConstant(1e3);  // does not count
    const auto undone = undo_spline(f, seen, order, half);
    ASSERT_TRUE(undone);
    EXPECT_LT(rms(undone->samples, y, seen), 1e-5) << order;
    EXPECT_TRUE(std::isnan(undone->samples(42, 0)));
  }
}

TEST(SplineUndo, TheErrorOfRoundedNumbersIsWhatItSays) {
  const std::vector<bool> all(1000, true);
  const auto y = recording(1000, 3);
  int stated = 0;
  for (int order = 2; order <= 5; ++order)
    for (const double cutoff_hz : {6.0, 12.0, 20.0}) {
      const double half = half_power_of(order, cutoff_hz, kRate);
      DifferenceSmoother smoother(all, order);
      if (!smoother.factor(half)) continue;
      SeriesMatrix f = y;
      smoother.smooth(f);
      for (std::int64_t i = 0; i < f.size(); ++i) f.data()[i] = 1e-4 * std::round(1e4 * f.data()[i]);
      const auto undone = undo_spline(f, all, order, half, 1e-4 / std::sqrt(12.0));
      ASSERT_TRUE(undone);
      const double error = rms(undone->samples, y, all);
      EXPECT_NEAR(error / undone->error_sd, 1.0, 0.35) << order << " " << cutoff_hz;
      ++stated;
    }
  EXPECT_GE(stated, 10);
}

TEST(SplineUndo, LowCutOffsOfHighOrdersAreBeyondSinglePrecision) {
  // 600 mm in single precision: steps of 6e-5 mm, and in double.
  const double single = 600.0 * 0x1p-24 / std::sqrt(3.0), twice = 600.0 * 0x1p-53 / std::sqrt(3.0);
  const auto gain = [](int order, double cutoff_hz) {
    return undo_gain(order, half_power_of(order, cutoff_hz, kRate));
  };
  EXPECT_GT(gain(5, 6.0) * single, 30.0);
  EXPECT_LT(gain(3, 12.0) * single, 0.01);
  EXPECT_LT(gain(5, 6.0) * twice, 1e-3);
  EXPECT_LT(gain(3, 6.0), gain(4, 6.0));
  EXPECT_GT(gain(3, 6.0), gain(3, 7.0));
  EXPECT_NEAR(gain(3, 1e6), 1.0, 1e-12) << "nothing was smoothed";
}

TEST(SplineUndo, TheHalfPowerFrequencyIsThatOfMinusThreeDecibels) {
  // |H| = 1 / (1 + (f / f0)^2m) is 1 / sqrt 2 at the cut-off.
  for (int order = 1; order <= 5; ++order) {
    const double half = half_power_of(order, 10.0, 200.0);
    EXPECT_NEAR(1.0 / (1.0 + std::pow(0.05 / half, 2 * order)), std::sqrt(0.5), 1e-12);
  }
}

TEST(SplineUndo, TooManyMissingIsSaid) {
  std::vector<bool> seen(20'000, false);
  for (std::size_t i = 0; i < seen.size(); i += 4) seen[i] = true;
  EXPECT_FALSE(undo_spline(SeriesMatrix::Zero(20'000, 1), seen, 3, 0.1));
}

}  // namespace
}  // namespace kinemark::math
