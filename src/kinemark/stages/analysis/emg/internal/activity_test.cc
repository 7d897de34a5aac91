// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/internal/activity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/emg/internal/spectral_noise.h"

namespace kinemark::analysis {
namespace {

using Eigen::VectorXd;

constexpr double kFast_hz = 2000.0;
constexpr Eigen::Index kLong = 12000;

template <typename F>
Activity activity_of(const F& strength, std::uint64_t seed) {
  Random random(seed, 8);
  VectorXd muscle(kLong), rest(kLong);
  for (double& x : muscle) x = random.gaussian();
  for (double& x : rest) x = random.gaussian();
  const EnvelopeOptions band;
  muscle = band_passed(muscle, kFast_hz, {.low_pass_hz = 250.0});
  rest = band_passed(rest, kFast_hz, band);
  muscle /= std::sqrt(muscle.squaredNorm() / static_cast<double>(kLong));
  rest /= std::sqrt(rest.squaredNorm() / static_cast<double>(kLong));
  for (Eigen::Index i = 0; i < kLong; ++i) rest[i] += strength(static_cast<double>(i) / kFast_hz) * muscle[i];
  return find_activity(band_passed(rest, kFast_hz, band), kFast_hz, {.band = band, .seed = seed});
}

TEST(Activity, TheInstantsOfABurstAreHeld) {
  int inside = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const auto found = activity_of([](double t) { return t >= 1.503 && t < 2.801 ? 8.0 : 0.0; }, seed);
    ASSERT_EQ(found.found, Quiet::Found::bursts);
    ASSERT_EQ(found.bursts.size(), 1u);
    EXPECT_NEAR(found.bursts[0].onset / kFast_hz, 1.503, 0.012);
    EXPECT_NEAR(found.bursts[0].end / kFast_hz, 2.801, 0.012);
    std::vector<double> length;
    for (const auto& draw : found.draws) length.push_back((draw[0].end - draw[0].onset) / kFast_hz);
    std::ranges::sort(length);
    inside += length[2] <= 1.298 && 1.298 <= length[96];
  }
  EXPECT_GE(inside, 10);
}

TEST(Activity, RestIsAllThatLiesWellOutsideBursts) {
  const auto found = activity_of([](double t) { return t < 1.0 || t >= 5.0 ? 10.0 : 0.0; }, 3);
  ASSERT_EQ(found.bursts.size(), 2u);
  EXPECT_EQ(found.bursts[0].onset, 0.0) << "cut by the recording";
  EXPECT_EQ(found.bursts[1].end, static_cast<double>(kLong - 1));
  EXPECT_NEAR(static_cast<double>(std::ranges::count(found.rest, 1)) / kFast_hz, 3.95, 0.03);
  EXPECT_EQ(found.rest[at(std::int64_t{6000})], 1);
  EXPECT_EQ(found.rest[at(std::int64_t{500})], 0);
}

TEST(Activity, AlwaysAndNeverActiveAreTheSameToAnElectrode) {
  for (const double strength : {0.0, 10.0})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const auto found = activity_of([&](double) { return strength; }, seed);
      EXPECT_EQ(found.found, Quiet::Found::steady);
      EXPECT_TRUE(found.bursts.empty());
      EXPECT_EQ(std::ranges::count(found.rest, 1), 0);
    }
}

TEST(SpectralNoise, NarrowerNoiseSaysLess) {
  Random random(3, 9);
  VectorXd white(kLong);
  for (double& x : white) x = random.gaussian();
  EXPECT_NEAR(SpectralNoise(white, kFast_hz).freedom_of_a_sample(), 1.0, 0.05);
  const auto narrow = band_passed(white, kFast_hz, {.high_pass_hz = 0.0, .low_pass_hz = 250.0});
  EXPECT_NEAR(SpectralNoise(narrow, kFast_hz).freedom_of_a_sample(), 0.26, 0.04) << "250 of 1000 Hz";
  EXPECT_NEAR(SpectralNoise(narrow, kFast_hz).median_hz(kFast_hz), 120.0, 15.0);
  EXPECT_NEAR(SpectralNoise(narrow, kFast_hz).draw(1, 2, 3).squaredNorm() / static_cast<double>(kLong), 1.0,
              0.1);
}

}  // namespace
}  // namespace kinemark::analysis
