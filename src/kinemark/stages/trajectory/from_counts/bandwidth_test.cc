// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/from_counts/bandwidth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"

namespace kinemark::trajectory {
namespace {

std::vector<LedObservation> wave(double hz, double sd, int n, std::uint64_t seed = 3) {
  Random random(seed, 1);
  std::vector<LedObservation> out;
  for (int k = 0; k < n; ++k) {
    const double t = 0.01 * k, phase = 2.0 * std::numbers::pi * hz * t;
    const Eigen::Vector3d noise{random.gaussian(), random.gaussian(), random.gaussian()};
    out.push_back(
        {t, Eigen::Matrix3d::Identity() / (sd * sd),
         Eigen::Vector3d(0.2 * std::cos(phase), 0.2 * std::sin(phase), 0.02 * std::cos(2.0 * phase)) +
             sd * noise});
  }
  return out;
}

TEST(Bandwidth, FasterMotionGetsAHigherCutoff) {
  const auto slow = choose_bandwidth(wave(0.5, 5e-4, 400)), fast = choose_bandwidth(wave(3.0, 5e-4, 400));
  EXPECT_GT(fast.cutoff_hz, 2.0 * slow.cutoff_hz);
  EXPECT_LT(fast.cutoff_hz, 35.0);
}

TEST(Bandwidth, MoreNoiseGetsALowerCutoff) {
  EXPECT_GT(choose_bandwidth(wave(1.5, 1e-4, 400)).cutoff_hz,
            choose_bandwidth(wave(1.5, 5e-3, 400)).cutoff_hz);
}

TEST(Bandwidth, KeepsWhatWasAskedFor) {
  const auto found = choose_bandwidth(wave(1.5, 5e-4, 300), {.order = 3, .half_gain_hz = 8.0});
  EXPECT_EQ(found.order, 3);
  EXPECT_NEAR(found.cutoff_hz, 8.0 * std::pow(std::numbers::sqrt2 - 1.0, 1.0 / 6.0), 1e-9);
}

TEST(Bandwidth, AFlashCountsNoMoreThanAskedAndQuietRecordsAreTheSame) {
  auto quiet = wave(1.5, 5e-4, 400), flashed = quiet;
  for (const int k : {60, 61, 127, 128, 194, 195, 261, 262, 328, 329})
    flashed[static_cast<std::size_t>(k)].position.x() += 5e-3;
  const double asked = choose_bandwidth(quiet).cutoff_hz;
  EXPECT_GT(choose_bandwidth(flashed).cutoff_hz, 1.5 * asked);
  EXPECT_NEAR(choose_bandwidth(flashed, {.most_squares = 9.0}).cutoff_hz, asked, 0.1 * asked);
  EXPECT_NEAR(choose_bandwidth(quiet, {.most_squares = 9.0}).cutoff_hz, asked, 0.1 * asked);
}

TEST(Bandwidth, ANarrowSearchFindsTheSame) {
  const auto observations = wave(1.5, 5e-4, 400);
  const auto wide = choose_bandwidth(observations);
  const double hz = 0.5 / (3.14159265 * wide.time_constant_s);
  const auto narrow = choose_bandwidth(observations, {.around_hz = 1.2 * hz});
  EXPECT_LT(narrow.sure, wide.sure + 0.5);
}

TEST(Bandwidth, LongRecordsAreJudgedByPieces) {
  const auto whole = choose_bandwidth(wave(1.5, 5e-4, 3000), {.max_observations = 100'000});
  const auto pieces = choose_bandwidth(wave(1.5, 5e-4, 3000));
  EXPECT_NEAR(pieces.cutoff_hz / whole.cutoff_hz, 1.0, 0.35);
}

TEST(Bandwidth, IncompleteObservationsDoNotCount) {
  auto observations = wave(1.5, 5e-4, 400);
  for (std::size_t k = 100; k < 130; ++k) {
    observations[k].information.row(2).setZero();
    observations[k].information.col(2).setZero();
    observations[k].position.z() = 1e3;
  }
  const double ratio =
      choose_bandwidth(observations).cutoff_hz / choose_bandwidth(wave(1.5, 5e-4, 400)).cutoff_hz;
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 2.0);
}

TEST(Bandwidth, TooFewObservationsFallBackToSixHertz) {
  const auto found = choose_bandwidth(wave(1.5, 5e-4, 8));
  EXPECT_EQ(found.order, 4);
  EXPECT_NEAR(found.time_constant_s, 1.0 / (12.0 * std::numbers::pi), 1e-12);
  EXPECT_GT(choose_bandwidth({}).spectral_density, 0.0);
}

TEST(Bandwidth, NamesAMemberOfTheFamily) {
  const auto b = bandwidth_at(4, 5.0, 4e6, 0.01);
  EXPECT_NEAR(b.spectral_density, std::pow(10.0 * std::numbers::pi, 8) * 0.01 / 4e6,
              1e-6 * b.spectral_density);
  EXPECT_THROW(static_cast<void>(bandwidth_at(6, 5.0, 1.0, 1.0)), ContractError);
}

}  // namespace
}  // namespace kinemark::trajectory
