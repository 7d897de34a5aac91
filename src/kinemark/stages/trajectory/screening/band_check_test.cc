// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/band_check.h"

#include <gtest/gtest.h>

#include "kinemark/core/check.h"
#include "kinemark/stages/trajectory/screening/testing/walker.h"

namespace kinemark::trajectory {
namespace {

using data::BandVerdict;

using data::Trajectories;

TEST(CheckBand, WhiteNoiseIsOpenAndMeasuredRight) {
  for (const double noise : {0.00005, 0.001}) {
    const data::BandCheck b = check_band(testing::walker({.frames = 3000, .noise_m = noise}), 0);
    EXPECT_EQ(b.verdict, BandVerdict::open);
    EXPECT_NEAR(b.top_m / noise, 1.0, 0.1);
    EXPECT_NEAR(b.middle_m / noise, 1.0, 0.1);
    EXPECT_LT(b.edge_hz, 10.0);
  }
}

/// Mean of neighbours, again and again: a low-pass filter.
Trajectories smoothed(int times) {
  Trajectories t = testing::walker({.frames = 1500});
  for (int k = 0; k < times; ++k) {
    const Trajectories before = t;
    for (std::int64_t f = 1; f + 1 < t.frames(); ++f)
      for (std::int64_t m = 0; m < t.markers(); ++m)
        t.x(f, m) = 0.25 * before.x(f - 1, m) + 0.5 * before.x(f, m) + 0.25 * before.x(f + 1, m);
  }
  return t;
}

TEST(CheckBand, AFilteredStreamIsSaidToBe) {
  const data::BandCheck b = check_band(smoothed(6), 3);
  EXPECT_EQ(b.verdict, BandVerdict::low_passed);
  EXPECT_LT(b.top_m, 1e-5);
  EXPECT_GT(b.edge_hz, 10.0);
}

TEST(CheckBand, AModelWithoutNoiseIsSaidToBeLowPassed) {
  EXPECT_EQ(check_band(testing::walker({.frames = 600, .noise_m = 0.0}), 1).verdict, BandVerdict::low_passed);
}

TEST(CheckBand, RoundingDoesNotPassForNoise) {
  Trajectories t = smoothed(12);
  for (double& x : t.x_in_world) x = std::round(x / 1e-5) * 1e-5;
  EXPECT_EQ(check_band(t, 2).verdict, BandVerdict::low_passed);
}

TEST(CheckBand, TakesTheLongestCompleteStretchAndSaysWhenThereIsNone) {
  Trajectories t = testing::walker({.frames = 400});
  for (std::int64_t f = 63; f < 400; f += 64) t.set_missing(f, 0);
  EXPECT_EQ(check_band(t, 0).verdict, BandVerdict::unknown);
  for (std::int64_t f = 63; f < 400; f += 100) t.set_missing(f, 1);
  EXPECT_EQ(check_band(t, 1).verdict, BandVerdict::open);
  EXPECT_EQ(check_band(testing::walker({.frames = 0}), 0).verdict, BandVerdict::unknown);
}

TEST(CheckBand, RefusesAMarkerThatIsNotThere) {
  EXPECT_THROW((void)check_band(testing::walker(), 8), ContractError);
}

}  // namespace
}  // namespace kinemark::trajectory
