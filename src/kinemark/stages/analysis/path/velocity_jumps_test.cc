// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/internal/velocity_jumps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/analysis/path/refits.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis::internal {
namespace {

constexpr double kPeriod_s = 0.6, kHeight_m = 0.06;

/// Taps at whole multiples of kPeriod_s after 0.4 s: there the velocity turns round.
Eigen::Vector3d tapping(double t) {
  const double phase = M_PI * (t - 0.4) / kPeriod_s;
  return {kHeight_m * std::abs(std::sin(phase)), 0.02 * std::sin(2.0 * phase), 1.0};
}
/// A reach that stops sharply: there the acceleration jumps, the velocity does not.
Eigen::Vector3d sharp_stop(double t) {
  const double u = std::clamp((t - 1.0) / 0.65, 0.0, 1.0);
  return {0.35 * u * u * u * (4.0 - 3.0 * u), 0.0, 1.0};
}

template <class Place>
math::SeriesMatrix noisy(const Place& place, double rate_hz, double sd, std::uint64_t seed,
                         double seconds = 8.0) {
  const auto x = testing::sampled(std::llround(seconds * rate_hz), rate_hz, place);
  return with_noise(x, std::vector<bool>(static_cast<std::size_t>(x.rows()), true), sd, seed, 1, 0);
}
std::vector<VelocityJump> found(const math::SeriesMatrix& x, double rate_hz) {
  return find_velocity_jumps(x, std::vector<bool>(static_cast<std::size_t>(x.rows()), true), rate_hz);
}

TEST(VelocityJumps, AreFoundWhereAPointTaps) {
  for (const double rate_hz : {100.0, 200.0, 1000.0})
    for (const double sd : {1e-4, 5e-4}) {
      const auto jumps = found(noisy(tapping, rate_hz, sd, 3), rate_hz);
      ASSERT_EQ(jumps.size(), 13U) << rate_hz << " Hz, " << sd;
      for (std::size_t k = 0; k < jumps.size(); ++k) {
        EXPECT_NEAR(jumps[k].at / rate_hz, 0.4 + kPeriod_s * static_cast<double>(k), 0.004);
        EXPECT_NEAR(jumps[k].change(0, 0) * rate_hz, 2.0 * M_PI * kHeight_m / kPeriod_s, 0.1);
      }
    }
}

TEST(VelocityJumps, AreNoneInSmoothMovementsAndSharpStops) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const double rate_hz : {100.0, 200.0}) {
      EXPECT_TRUE(found(noisy(testing::ellipse, rate_hz, 3e-4, seed), rate_hz).empty()) << seed;
      EXPECT_TRUE(found(noisy(testing::reach, rate_hz, 3e-4, seed), rate_hz).empty()) << seed;
      EXPECT_TRUE(found(noisy(sharp_stop, rate_hz, 3e-4, seed), rate_hz).empty()) << seed;
    }
}

TEST(VelocityJumps, AreNoneInCorrelatedNoise) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    auto x = noisy([](double) { return Eigen::Vector3d(0.0, 0.0, 1.0); }, 100.0, 3e-4, seed);
    for (std::int64_t i = 1; i < x.rows(); ++i) x.row(i) = 0.9 * x.row(i - 1) + 0.1 * x.row(i);
    EXPECT_TRUE(found(x, 100.0).empty()) << seed;
  }
}

TEST(VelocityJumps, ASingleWrongSampleIsNone) {
  auto x = noisy(testing::ellipse, 100.0, 3e-4, 5);
  x.row(400) += Eigen::RowVector3d(0.01, 0.0, 0.0);
  EXPECT_TRUE(found(x, 100.0).empty());
}

TEST(VelocityJumps, AreNotSoughtWithFewSamplesOrAcrossGaps) {
  EXPECT_TRUE(found(noisy(tapping, 60.0, 1e-4, 3), 60.0).empty());
  const auto x = noisy(tapping, 100.0, 1e-4, 3);
  std::vector<bool> seen(800, true);
  seen[110] = false;  // near the second tap, bridged
  EXPECT_EQ(find_velocity_jumps(x, seen, 100.0).size(), 13U);
  for (std::size_t i = 340; i < 346; ++i) seen[i] = false;  // at the sixth
  EXPECT_EQ(find_velocity_jumps(x, seen, 100.0).size(), 12U);
}

/// Deviation of white noise that would have these fourth differences.
double roughness(const math::SeriesMatrix& x) {
  double squares = 0.0;
  for (std::int64_t i = 2; i + 2 < x.rows(); ++i)
    squares += (x.row(i - 2) - 4.0 * x.row(i - 1) + 6.0 * x.row(i) - 4.0 * x.row(i + 1) + x.row(i + 2))
                   .squaredNorm();
  return std::sqrt(squares / (3.0 * 70.0 * static_cast<double>(x.rows() - 4)));
}

TEST(WithoutJumps, LeavesTheNoiseAndASmoothPath) {
  const auto x = noisy(tapping, 100.0, 5e-5, 7);
  EXPECT_GT(roughness(x), 1e-4);
  EXPECT_NEAR(roughness(without_jumps(x, found(x, 100.0))), 5e-5, 1e-5);
  EXPECT_EQ(without_jumps(x, {}), x);
}

}  // namespace
}  // namespace kinemark::analysis::internal
