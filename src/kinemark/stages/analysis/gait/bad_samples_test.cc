// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/bad_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

// A marker that swings by half a metre, with 0.2 mm of noise.
data::Trajectories swinging(double rate_hz = 100.0, double noise_m = 2e-4) {
  auto out = data::Trajectories::all_missing({"LHEE"}, {.rate_hz = rate_hz, .frames = 300});
  Random random(5, 1);
  for (std::int64_t f = 0; f < 300; ++f) {
    const double phase = 2.0 * 3.14159265 * static_cast<double>(f) / rate_hz;
    out.x(f, 0) = Eigen::Vector3d(0.25 * std::sin(phase), 0.1, 0.05);
    for (int axis = 0; axis < 3; ++axis) out.x(f, 0)[axis] += noise_m * random.gaussian();
    out.state[out.index(f, 0)] = data::SampleState::measured;
  }
  return out;
}

std::int64_t believed(const SamplesBelieved& samples) { return std::ranges::count(samples.seen, true); }

TEST(BadSamples, ACleanMarkerIsBelievedWhole) {
  for (const double rate : {25.0, 100.0, 1000.0}) {
    const auto samples = believe_samples(swinging(rate), 0);
    EXPECT_EQ(believed(samples), 300) << rate;
    EXPECT_EQ(samples.leaps, 0);
    EXPECT_TRUE(samples.held.empty());
  }
}

TEST(BadSamples, ALeapThereAndBackIsLeftOut) {
  auto markers = swinging();
  markers.x(80, 0).z() += 0.3;
  const auto samples = believe_samples(markers, 0);
  EXPECT_FALSE(samples.seen[80]);
  EXPECT_TRUE(samples.seen[78] && samples.seen[82]);
  EXPECT_GE(samples.leaps, 1);
}

TEST(BadSamples, TenMillimetresOfNoiseAreNoLeaps) {
  EXPECT_EQ(believe_samples(swinging(100.0, 0.01), 0).leaps, 0);
}

TEST(BadSamples, ANeighbourAcrossAGapTellsNothing) {
  auto markers = swinging(25.0);
  for (const std::int64_t f : {50, 52}) markers.set_missing(f, 0);
  EXPECT_TRUE(believe_samples(markers, 0).seen[51]);
}

TEST(BadSamples, APlaceHeldUntilALeapIsMissing) {
  auto markers = swinging();
  for (std::int64_t f = 101; f < 125; ++f) markers.x(f, 0) = Eigen::Vector3d(markers.x(100, 0));
  const auto samples = believe_samples(markers, 0);
  ASSERT_EQ(samples.held.size(), 1u);
  EXPECT_EQ(samples.held[0].first, 101);
  EXPECT_EQ(samples.held[0].last, 124);
  EXPECT_TRUE(samples.seen[100]);
  EXPECT_FALSE(samples.seen[110]);
}

TEST(BadSamples, APlaceHeldToTheEndIsMissing) {
  auto markers = swinging();
  for (std::int64_t f = 221; f < 300; ++f) markers.x(f, 0) = Eigen::Vector3d(markers.x(220, 0));
  const auto samples = believe_samples(markers, 0);
  ASSERT_EQ(samples.held.size(), 1u);
  EXPECT_EQ(samples.held[0].count(), 79);
}

TEST(BadSamples, WholeNumbersHoldAFootThatStands) {
  auto markers = swinging();
  for (std::int64_t f = 0; f < 300; ++f) {
    if (f >= 100 && f < 200) markers.x(f, 0) = Eigen::Vector3d(markers.x(100, 0));
    for (int axis = 0; axis < 3; ++axis)
      markers.x(f, 0)[axis] = 1e-4 * std::round(1e4 * markers.x(f, 0)[axis]);
  }
  markers.x(200, 0) = Eigen::Vector3d(markers.x(199, 0));
  for (std::int64_t f = 200; f < 300; ++f)
    markers.x(f, 0).x() = markers.x(199, 0).x() + 0.002 * static_cast<double>(f - 199);
  EXPECT_TRUE(believe_samples(markers, 0).held.empty());
}

}  // namespace
}  // namespace kinemark::analysis
