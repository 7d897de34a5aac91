// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/harmonics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/path/timing.h"

namespace kinemark::analysis {
namespace {

constexpr double kCircle = 2.0 * std::numbers::pi;

// A movement whose phase, in cycles, is a function of time.
PathMatrix turning(double seconds, double rate_hz, const std::function<double(double)>& cycles,
                   const std::function<Eigen::Vector3d(double)>& shape) {
  PathMatrix out(std::llround(seconds * rate_hz), 3);
  for (Eigen::Index i = 0; i < out.rows(); ++i)
    out.row(i) = shape(kCircle * cycles(static_cast<double>(i) / rate_hz)).transpose();
  return out;
}

HarmonicFit fit_of(const PathMatrix& x, double rate_hz) {
  const double peak = peak_frequency(periodogram_of(x, rate_hz), 0.3);
  return fit_harmonics(x, rate_hz, harmonic_form(x, rate_hz, peak));
}

Eigen::Vector3d oval(double angle) { return {0.1 * std::sin(angle), 0.04 * std::cos(angle), 0.0}; }

TEST(Harmonics, CyclesNeedNotBeWhole) {
  for (const double cycles : {2.3, 2.5, 3.2, 5.75, 8.0, 12.4, 40.1})
    for (const double begin : {0.0, 0.2, 0.4}) {
      const double hz = 0.8;
      const auto x = turning(cycles / hz, 100.0, [&](double t) { return hz * t + begin; }, oval);
      const auto fit = fit_of(x, 100.0);
      EXPECT_NEAR(fit.dominant_hz, hz, 1e-7) << cycles << " " << begin;
      EXPECT_LT(std::sqrt(fit.wander), 1e-6) << cycles << " " << begin;
      // The largest value of the periodogram is off by more.
      if (cycles < 3.0) {
        EXPECT_GT(std::abs(peak_frequency(periodogram_of(x, 100.0), 0.3) - hz), 1e-4) << cycles;
      }
    }
}

TEST(Harmonics, TrendAndMultiplesDoNotMoveIt) {
  const double hz = 1.13;
  auto x = turning(
      6.1, 100.0, [&](double t) { return hz * t + 0.3; },
      [](double a) -> Eigen::Vector3d {
        return {0.1 * std::sin(a) + 0.03 * std::cos(2.0 * a), 0.02 * std::sin(3.0 * a + 1.0),
                0.01 * std::cos(5.0 * a)};
      });
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double t = static_cast<double>(i) / 100.0;
    x(i, 0) += 0.3 * t, x(i, 1) += 0.01 * t * t, x(i, 2) -= 0.002 * t * t * t;
  }
  EXPECT_NEAR(fit_of(x, 100.0).dominant_hz, hz, 1e-7);
}

TEST(Harmonics, ADominantFrequencyMayBeTwiceTheFundamental) {
  const auto shape = [](double a) -> Eigen::Vector3d {
    return {0.02 * std::sin(a), 0.1 * std::sin(2.0 * a + 0.4), 0.01 * std::cos(3.0 * a)};
  };
  const auto x = turning(7.3, 100.0, [](double t) { return 0.7 * t + 0.1; }, shape);
  const double peak = peak_frequency(periodogram_of(x, 100.0), 0.3);
  EXPECT_EQ(harmonic_form(x, 100.0, peak).dominant, 2);
  EXPECT_NEAR(fit_of(x, 100.0).dominant_hz, 1.4, 1e-7);
  // One that is not there is not taken.
  const auto even = turning(7.3, 100.0, [](double t) { return 1.4 * t; }, oval);
  EXPECT_EQ(harmonic_form(even, 100.0, 1.4).dominant, 1);
}

TEST(Harmonics, OfLongSeriesMeansAreFitted) {
  const auto x = turning(300.0, 240.0, [](double t) { return 0.931 * t; }, oval);
  EXPECT_NEAR(fit_of(x, 240.0).dominant_hz, 0.931, 1e-6);
}

TEST(Harmonics, CyclesThatDifferWidenIt) {
  Random random(5, 1);
  int inside = 0, all = 0;
  double widest = 0.0;
  for (int k = 0; k < 120; ++k) {
    const double hz = 1.0, seconds = k % 2 == 0 ? 4.6 : 15.3;
    std::vector<double> starts{-random.uniform()};
    while (starts.back() < seconds) starts.push_back(starts.back() + 1.0 + 0.03 * random.gaussian());
    const auto cycles = [&](double t) {
      std::size_t i = 0;
      while (i + 2 < starts.size() && starts[i + 1] <= t) ++i;
      return static_cast<double>(i) + (t - starts[i]) / (starts[i + 1] - starts[i]);
    };
    const auto fit = fit_of(turning(seconds, 100.0, cycles, oval), 100.0);
    ASSERT_TRUE(std::isfinite(fit.wander));
    inside += std::abs(fit.dominant_hz - hz) < 1.96 * std::sqrt(fit.wander);
    widest = std::max(widest, std::sqrt(fit.wander));
    ++all;
  }
  EXPECT_GE(inside, all * 88 / 100);
  EXPECT_LT(widest, 0.3);
}

TEST(Harmonics, NothingOfWhatDoesNotRepeat) {
  const auto x = turning(1.0, 100.0, [](double t) { return 0.9 * t; }, oval);
  EXPECT_TRUE(std::isnan(fit_harmonics(x, 100.0, harmonic_form(x, 100.0, 0.9)).dominant_hz));
  EXPECT_TRUE(std::isnan(fit_harmonics(x, 100.0, harmonic_form(x, 100.0, kNaN)).dominant_hz));
}

}  // namespace
}  // namespace kinemark::analysis
