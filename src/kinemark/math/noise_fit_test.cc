// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/noise_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/math/digital_filter.h"

namespace kinemark::math {
namespace {

constexpr double kFrames_hz = 100.0;
constexpr double kWholeTurn = 2.0 * std::numbers::pi;

// Metres: cycles of 0.2 m, different ones for each seed.
SeriesMatrix movement(std::int64_t n, std::uint64_t seed) {
  Random random(seed, 9);
  const double hz = random.uniform(0.5, 1.2), phase = random.uniform(0.0, 6.0);
  SeriesMatrix out(n, 3);
  for (std::int64_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / kFrames_hz, turn = kWholeTurn * hz * t + phase;
    out.row(i) << 0.2 * std::sin(turn), 0.1 * std::cos(turn), 0.02 * std::sin(2.0 * turn);
  }
  return out;
}

SeriesMatrix noise(std::int64_t n, double sd, double rho, std::uint64_t seed) {
  Random random(seed, 1);
  SeriesMatrix out(n, 3);
  for (int k = 0; k < 3; ++k) {
    double e = random.gaussian();
    for (std::int64_t i = 0; i < n; ++i) {
      out(i, k) = sd * e;
      e = rho * e + std::sqrt(1.0 - rho * rho) * random.gaussian();
    }
  }
  return out;
}

SeriesMatrix both_ways(const SeriesMatrix& x, double design_hz) {
  const auto sections = butterworth_lowpass(2, design_hz / kFrames_hz);
  SeriesMatrix out = x;
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    std::vector<double> column(x.col(k).begin(), x.col(k).end());
    filter_both_ways(sections, 100, column);
    for (std::int64_t i = 0; i < x.rows(); ++i)
      out(i, k) = static_cast<float>(column[static_cast<std::size_t>(i)]);
  }
  return out;
}

SeriesMatrix splined(SeriesMatrix x, int order, double half_hz) {
  DifferenceSmoother smoother(std::vector<bool>(static_cast<std::size_t>(x.rows()), true), order);
  EXPECT_TRUE(smoother.factor(half_hz / kFrames_hz));
  smoother.smooth(x);
  for (auto& value : x.reshaped()) value = static_cast<float>(value);
  return x;
}

FoundNoise found_in(const SeriesMatrix& x) {
  const NoiseSpectrum spectrum(x, std::vector<bool>(static_cast<std::size_t>(x.rows()), true));
  const auto found = find_noise(spectrum, kFrames_hz);
  if (!found) throw std::runtime_error("no noise found");
  return *found;
}

int count_of(const std::function<SeriesMatrix(std::uint64_t)>& make, NoiseKind kind, int seeds) {
  int count = 0;
  for (int seed = 1; seed <= seeds; ++seed)
    count += found_in(make(static_cast<std::uint64_t>(seed))).model().kind == kind;
  return count;
}

TEST(FindNoise, WhiteNoiseIsCalledWhiteAndHasItsDeviation) {
  std::vector<double> ratios;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const double sd = 1e-4 * static_cast<double>(1 + seed % 20);
    const auto found = found_in(movement(500, seed) + noise(500, sd, 0.0, seed));
    EXPECT_TRUE(found.fits());
    if (found.model().kind == NoiseKind::white) ratios.push_back(found.model().sd() / sd);
  }
  EXPECT_GE(ratios.size(), 19u);
  for (const double ratio : ratios) EXPECT_NEAR(ratio, 1.0, 0.12);
}

TEST(FindNoise, CorrelatedNoiseIsFound) {
  for (const double rho : {0.7, 0.9, 0.99})
    EXPECT_GE(
        count_of([rho](std::uint64_t s) { return (movement(500, s) + noise(500, 1e-3, rho, s)).eval(); },
                 NoiseKind::correlated, 10) +
            count_of([rho](std::uint64_t s) { return (movement(500, s) + noise(500, 1e-3, rho, s)).eval(); },
                     NoiseKind::correlated_and_white, 10),
        9)
        << rho;
  const auto found = found_in(movement(3000, 2) + noise(3000, 1e-3, 0.9, 2));
  EXPECT_NEAR(found.model().correlation, 0.9, 0.04);
  EXPECT_NEAR(found.model().sd(), 1e-3, 3e-4);
}

TEST(FindNoise, AFilterIsFoundWithItsFormCutOffAndTheNoiseBefore) {
  int orders = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto found = found_in(both_ways(movement(500, seed) + noise(500, 5e-4, 0.0, seed), 8.0)).model();
    ASSERT_EQ(found.kind, NoiseKind::filtered) << seed;
    orders += found.form == LowPass::butterworth && found.order == 2;
    EXPECT_NEAR(std::log(found.half * kFrames_hz / 8.0), 0.0, 0.25) << seed;
    EXPECT_NEAR(std::log(std::sqrt(found.variance) / 5e-4), 0.0, 0.6) << seed;
  }
  EXPECT_GE(orders, 7);
  const auto quintic = found_in(splined(movement(500, 3) + noise(500, 5e-4, 0.0, 3), 3, 7.0)).model();
  EXPECT_EQ(quintic.kind, NoiseKind::filtered);
  EXPECT_EQ(quintic.form, LowPass::spline);
  EXPECT_EQ(quintic.order, 3);
  EXPECT_NEAR(quintic.half * kFrames_hz, 7.0, 0.5);
}

TEST(FindNoise, FiltersThatLetNoiseThroughUpToTheHighestFrequencyAreFound) {
  // At 0.26 of the rate much is left of 3 mm of noise at the highest frequency. Few are short of evidence.
  int found_count = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto x = splined(movement(600, seed) + noise(600, 3e-3, 0.0, seed), 3, 26.0);
    EXPECT_GT(NoiseSpectrum(x, std::vector<bool>(600, true)).bins(0.4).back().power, 7.5e-9)
        << "not rounding";
    const auto model = found_in(x).model();
    found_count += model.kind == NoiseKind::filtered && std::abs(model.half * kFrames_hz - 26.0) < 3.0;
  }
  EXPECT_GE(found_count, 7);
}

TEST(FindNoise, SlowNoiseUnderAMovementIsNotTakenForItsTail) {
  // Pulses whose spectrum falls exponentially, as no power does.
  std::vector<double> over_true;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    SeriesMatrix x = movement(400, seed) + noise(400, 5e-4, 0.9, seed);
    for (std::int64_t i = 0; i < x.rows(); ++i) {
      const double away = std::remainder(static_cast<double>(i) / kFrames_hz, 1.0) / 0.1;
      x(i, 0) += 0.1 / (1.0 + away * away);
    }
    const NoiseModel truth{.kind = NoiseKind::correlated, .variance = 2.5e-7, .correlation = 0.9};
    over_true.push_back(found_in(x).model().power(0.02) / truth.power(0.02));
  }
  std::ranges::sort(over_true);
  EXPECT_GT(over_true[7], 0.7);
  EXPECT_LT(over_true[7], 1.4);
}

TEST(FindNoise, NoFilterIsClaimedWithoutAFloorAsLowAsRounding) {
  // Correlated noise with as steep a slope as a filter has, but 0.2 mm of white noise on it.
  const auto filtered = both_ways(movement(600, 5) + noise(600, 2e-3, 0.0, 5), 6.0);
  const SeriesMatrix with_floor = filtered + noise(600, 2e-4, 0.0, 6);
  EXPECT_EQ(found_in(filtered).model().kind, NoiseKind::filtered);
  EXPECT_NE(found_in(with_floor).model().kind, NoiseKind::filtered);
}

TEST(FindNoise, NoiseThatFitsNoModelIsDistinguished) {
  // A line at 30 Hz, far above white noise.
  SeriesMatrix x = movement(800, 1) + noise(800, 1e-4, 0.0, 1);
  EXPECT_TRUE(found_in(x).fits());
  for (std::int64_t i = 0; i < 800; ++i)
    x.row(i).array() += 2e-3 * std::sin(kWholeTurn * 0.30 * static_cast<double>(i)) +
                        2e-3 * std::sin(kWholeTurn * 0.44 * static_cast<double>(i));
  EXPECT_FALSE(found_in(x).fits());
}

TEST(FindNoise, AKnownFilterIsKept) {
  const NoiseSpectrum spectrum(splined(movement(400, 3) + noise(400, 5e-4, 0.0, 3), 4, 9.0),
                               std::vector<bool>(400, true));
  const NoiseSearch search{.known = NoiseModel{.kind = NoiseKind::filtered,
                                               .form = LowPass::spline,
                                               .order = 4,
                                               .variance = 2.5e-7,
                                               .half = 0.09}};
  const auto found = find_noise(spectrum, kFrames_hz, search);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->chosen.fits.size(), 2u) << "with both tails of the movement";
  for (const auto& fit : found->chosen.fits) EXPECT_EQ(fit.model.order, 4);
  EXPECT_NEAR(found->model().half, 0.09, 0.004);
  EXPECT_NEAR(std::sqrt(found->model().variance), 5e-4, 1e-4);
}

TEST(FindNoise, OfTooFewSamplesSaysNothing) {
  const NoiseSpectrum spectrum(noise(40, 1e-3, 0.0, 1), std::vector<bool>(40, true));
  EXPECT_FALSE(find_noise(spectrum, kFrames_hz));
}

TEST(DrawNoise, SpreadsAsFarAsTheRecordingLeavesOpen) {
  const auto spread = [](const SeriesMatrix& x) {
    auto draws = draw_noise(found_in(x), {}, 99, Random(1, 2));
    std::vector<double> slow;
    for (const auto& draw : draws) slow.push_back(draw.power(0.01));
    std::ranges::sort(slow);
    return slow[89] / slow[9];
  };
  const double white = spread(movement(500, 4) + noise(500, 1e-3, 0.0, 4));
  const double slow = spread(movement(500, 4) + noise(500, 1e-3, 0.99, 4));
  EXPECT_LT(white, 2.0);
  EXPECT_GT(slow, 4.0);
}

TEST(DrawNoise, IsTheSameForASeedAndAnotherForAnother) {
  const auto found = found_in(movement(500, 4) + noise(500, 1e-3, 0.7, 4));
  const auto a = draw_noise(found, {}, 40, Random(1, 2)), b = draw_noise(found, {}, 40, Random(1, 2)),
             c = draw_noise(found, {}, 40, Random(2, 2));
  ASSERT_EQ(a.size(), 40u);
  double same = 0.0, other = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    same += std::abs(a[i].variance - b[i].variance);
    other += std::abs(a[i].variance - c[i].variance);
  }
  EXPECT_EQ(same, 0.0);
  EXPECT_GT(other, 0.0);
}

}  // namespace
}  // namespace kinemark::math
