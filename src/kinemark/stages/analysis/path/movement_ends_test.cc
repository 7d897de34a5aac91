// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/internal/movement_ends.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/analysis/path/refits.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis::internal {
namespace {

constexpr double kRate_hz = 100.0, kNoise_m = 5e-4;
constexpr double kWay_m = 0.35, kLasts_s = 0.65;

// From 1 s on a straight way: sharp stop of the speed 12 u^2 (1 - u), and an impact at the speed 2 u.
double stopping(double u) { return u * u * u * (4.0 - 3.0 * u); }
double hitting(double u) { return u * u; }

template <class Share>
math::SeriesMatrix way(const Share& share, std::uint64_t seed, double drift_m_s = 0.0) {
  const auto x = testing::sampled(300, kRate_hz, [&](double t) {
    return Eigen::Vector3d(kWay_m * share(std::clamp((t - 1.0) / kLasts_s, 0.0, 1.0)),
                           drift_m_s * std::max(0.0, t - 1.65), 1.0);
  });
  return with_noise(x, std::vector<bool>(300, true), kNoise_m, seed, 2, 0);
}

EndQuestion question(bool begins, double near_s) {
  return {.begins = begins,
          .near_s = near_s,
          .movement_s = kLasts_s,
          .level = 0.05 * kWay_m / kLasts_s * 16.0 / 9.0,
          .noise_variance = kNoise_m * kNoise_m};
}

std::optional<SharpEnd> end_of(const math::SeriesMatrix& x, const EndQuestion& asked) {
  return fit_sharp_end(x, std::vector<bool>(static_cast<std::size_t>(x.rows()), true), kRate_hz, asked);
}

TEST(SharpEnds, OfASharpStopHoldTheTruth) {
  double share = 0.99;  // where 12 u^2 (1 - u) is a twentieth of its largest value
  for (int i = 0; i < 20; ++i) share = 1.0 - 0.8 / 9.0 / 12.0 / share / share;
  const double truth = 1.0 + kLasts_s * share, acceleration = 12.0 * kWay_m / kLasts_s / kLasts_s;
  int held = 0, bounded = 0;
  double error = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto end = end_of(way(stopping, seed), question(false, truth + 0.008));
    ASSERT_TRUE(end) << seed;
    EXPECT_FALSE(end->velocity_jumps) << seed;
    held += end->low_s <= truth && truth <= end->high_s;
    bounded += acceleration <= end->acceleration && end->acceleration < 1.6 * acceleration;
    error += (end->time_s - truth) / 40.0;
  }
  EXPECT_GE(held, 35);
  EXPECT_GE(bounded, 36);
  EXPECT_NEAR(error, 0.0, 0.001);
}

TEST(SharpEnds, OfAnImpactHaveAVelocityThatJumps) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto end = end_of(way(hitting, seed), question(false, 1.66));
    ASSERT_TRUE(end) << seed;
    EXPECT_TRUE(end->velocity_jumps) << seed;
    EXPECT_NEAR(end->time_s, 1.65, 0.003);
    EXPECT_TRUE(std::isnan(end->acceleration));
  }
}

TEST(SharpEnds, OfASmoothReachNeitherJumpNorMove) {
  const auto smooth = [](double u) { return testing::minimum_jerk(u); };
  const double level = 0.05 * 1.875 * kWay_m / kLasts_s;
  double share = 0.05;  // where 30 u^2 (1 - u)^2 is a twentieth of its largest value
  for (int i = 0; i < 40; ++i) share = std::sqrt(0.05 * 1.875 / 30.0) / (1.0 - share);
  const double truth = 1.0 + kLasts_s * share;
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    auto asked = question(true, truth);
    asked.level = level;
    const auto onset = end_of(way(smooth, seed), asked);
    ASSERT_TRUE(onset) << seed;
    EXPECT_FALSE(onset->velocity_jumps) << seed;
    held += onset->low_s <= truth && truth <= onset->high_s;
  }
  EXPECT_GE(held, 34);
}

TEST(SharpEnds, AreNotFoundWhereThePointDoesNotRestOrWasNotSeen) {
  EXPECT_TRUE(end_of(way(stopping, 3), question(false, 1.65)));
  EXPECT_FALSE(end_of(way(stopping, 3, 0.1), question(false, 1.65)));
  std::vector<bool> seen(300, true);
  for (std::size_t i = 166; i < 300; ++i) seen[i] = false;
  EXPECT_FALSE(fit_sharp_end(way(stopping, 3), seen, kRate_hz, question(false, 1.65)));
}

TEST(MovementEnds, StandInForThoseOfTheSmoothedPath) {
  const MovementEnds none;
  EXPECT_TRUE(std::isnan(none.value_of("movement_end", 1.7).value));
  MovementEnds ends{.onset = std::nullopt,
                    .end = SharpEnd{.time_s = 1.6, .low_s = 1.59, .high_s = 1.62, .acceleration = 9.0},
                    .first_s = 10.0,
                    .smooth_onset_s = 1.0,
                    .smooth_end_s = 1.7};
  EXPECT_TRUE(std::isnan(ends.value_of("onset", 11.0).value));
  const auto end = ends.value_of("movement_end", 11.7);
  EXPECT_NEAR(end.value, 11.6, 1e-12);
  EXPECT_NEAR(end.low, 11.59, 1e-12);
  EXPECT_NEAR(end.high, 11.62, 1e-12);
  const auto time = ends.value_of("movement_time", 0.7);
  EXPECT_NEAR(time.value, 0.6, 1e-12);
  EXPECT_NEAR(time.low, 0.59, 1e-12);
  EXPECT_NEAR(time.high, 0.62, 1e-12);
  const auto speed = ends.value_of("movement_mean_speed", 0.5);  // 0.4 m in 0.8 s
  EXPECT_NEAR(speed.value, 0.4 / 0.7, 1e-12);
  EXPECT_NEAR(speed.low, 0.4 / 0.72, 1e-12);
  EXPECT_NEAR(speed.high, 0.4 / 0.69, 1e-12);
  const auto most = ends.value_of("peak_acceleration", 8.0);
  EXPECT_TRUE(std::isnan(most.value));
  EXPECT_EQ(most.high, 9.0);
  EXPECT_TRUE(std::isnan(ends.value_of("path_length", 1.0).high));
  ends.onset = SharpEnd{.time_s = 1.1, .low_s = 1.07, .high_s = 1.14};
  EXPECT_NEAR(ends.value_of("movement_time", 0.7).low, 0.5 - std::hypot(0.01, 0.04), 1e-12);
}

}  // namespace
}  // namespace kinemark::analysis::internal
