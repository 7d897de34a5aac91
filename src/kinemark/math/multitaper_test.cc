// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/multitaper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"

namespace kinemark::math {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;

SeriesMatrix white(std::int64_t n, double sd, std::uint64_t seed) {
  Random random(seed, 1);
  SeriesMatrix out(n, 3);
  for (std::int64_t i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k) out(i, k) = sd * random.gaussian();
  return out;
}

// A movement of 300 mm that no noise comes near.
SeriesMatrix movement(std::int64_t n) {
  SeriesMatrix out(n, 3);
  for (std::int64_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / 100.0;
    out.row(i) << 300.0 * std::sin(kFullTurn * 0.7 * t), 100.0 * std::cos(kFullTurn * 0.9 * t), 40.0 * t;
  }
  return out;
}

double mean_power(const std::vector<SpectrumBin>& bins) {
  double sum = 0.0, count = 0.0;
  for (const auto& bin : bins) sum += bin.count * bin.power, count += bin.count;
  return sum / count;
}

TEST(SlepianTapers, AreOrthogonalAndHoldTheirEnergyInTheBand) {
  const std::int64_t n = 200;
  const auto tapers = slepian_tapers(n, 4.0, 5);
  for (std::size_t a = 0; a < tapers.size(); ++a)
    for (std::size_t b = 0; b <= a; ++b) EXPECT_NEAR(tapers[a].dot(tapers[b]), a == b ? 1.0 : 0.0, 1e-9);
  // Share of energy within 4/n by the kernel sin(2 pi W d) / (pi d); above 0.999 for all five (Slepian 1978).
  for (const auto& taper : tapers) {
    double inside = 0.0;
    for (std::int64_t i = 0; i < n; ++i)
      for (std::int64_t k = 0; k < n; ++k) {
        const double d = static_cast<double>(i - k), w = 4.0 / static_cast<double>(n);
        inside +=
            taper[i] * taper[k] * (i == k ? 2.0 * w : std::sin(kFullTurn * w * d) / (0.5 * kFullTurn * d));
      }
    EXPECT_GT(inside, 0.999);
    EXPECT_LE(inside, 1.0 + 1e-9);
  }
  // Of the first one all but 2e-10 lies inside, as tables have it (NW = 4).
  EXPECT_GT(tapers[0].minCoeff() * tapers[0].maxCoeff(), -1e-12);
}

TEST(NoiseSpectrum, OfWhiteNoiseIsItsVarianceAtAllFrequencies) {
  const std::vector<bool> seen(2000, true);
  const NoiseSpectrum spectrum(white(2000, 0.5, 3), seen);
  const auto bins = spectrum.bins(0.02);
  ASSERT_GT(bins.size(), 40u);
  // exp of a mean logarithm of gamma distributed powers of shape 15 is 3 % low, the least of six a little
  // more.
  EXPECT_NEAR(mean_power(bins), 0.25, 0.025);
  for (std::size_t i = 1; i < bins.size(); ++i) EXPECT_GT(bins[i].frequency, bins[i - 1].frequency);
  EXPECT_LE(bins.back().frequency, 0.5);
}

TEST(NoiseSpectrum, SeesNoiseUnderAMovementAMillionTimesLarger) {
  const std::vector<bool> seen(600, true);
  const SeriesMatrix noise = white(600, 1e-4, 4);
  const NoiseSpectrum spectrum(movement(600) + noise, seen), alone(noise, seen);
  const auto bins = spectrum.bins(0.12), without = alone.bins(0.12);
  EXPECT_NEAR(mean_power(bins) / mean_power(without), 1.0, 0.15);
  // Lower down the movement's own power is there: what is said to be noise is not taken from below it.
  EXPECT_GT(spectrum.bins(0.01).front().power, 1e4 * without.front().power);
}

TEST(NoiseSpectrum, TakesStretchesWithoutGapsAndBridgesSingleSamples) {
  std::vector<bool> seen(900, true);
  SeriesMatrix x = movement(900) + white(900, 0.2, 5);
  for (const std::size_t i : {80u, 200u, 201u, 444u})
    seen[i] = false, x.row(static_cast<Eigen::Index>(i)).setConstant(9e3);
  for (std::size_t i = 600; i < 640; ++i) seen[i] = false, x.row(static_cast<Eigen::Index>(i)).setZero();
  const NoiseSpectrum spectrum(x, seen);
  EXPECT_EQ(spectrum.longest(), 600);
  EXPECT_NEAR(mean_power(spectrum.bins(0.1)), 0.04, 0.006);
}

// Of 6 % bridged samples the power was 1.13 at low and 0.66 of what it is at the highest frequencies.
TEST(NoiseSpectrum, OfBridgedWhiteNoiseIsWhite) {
  constexpr std::int64_t kLength = 4000;
  std::vector<bool> seen(kLength, true);
  for (std::size_t i = 10; i + 10 < kLength; i += 17) seen[i] = false;
  const auto bins = NoiseSpectrum(white(kLength, 1.0, 7), seen).bins(0.02);
  double low = 0.0, high = 0.0, lows = 0.0, highs = 0.0;
  for (const auto& bin : bins) {
    if (bin.frequency < 0.15) low += bin.count * bin.power, lows += bin.count;
    if (bin.frequency > 0.40) high += bin.count * bin.power, highs += bin.count;
  }
  EXPECT_NEAR(low / lows, 1.0, 0.1);
  EXPECT_NEAR((high / highs) / (low / lows), 1.0, 0.12);
}

TEST(NoiseSpectrum, OfShortStretchesIsEmpty) {
  std::vector<bool> seen(300, true);
  for (std::size_t i = 0; i < 300; i += 50) seen[i] = seen[i + 1] = seen[i + 2] = false;
  EXPECT_TRUE(NoiseSpectrum(white(300, 1.0, 1), seen).empty());
  EXPECT_TRUE(NoiseSpectrum(white(300, 1.0, 1), seen).bins(0.1).empty());
}

}  // namespace
}  // namespace kinemark::math
