// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/from_counts/hand_on_start.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/data/filtering.h"

namespace kinemark::trajectory {
namespace {

using data::SampleState;
using Eigen::Vector3d;

constexpr std::int64_t kThrowFrames = 2000;
constexpr double kLate_s = 0.004;  ///< light of the first LED after its frame

/// A throw: x(t) = p + v t + a t^2 / 2, so that the path between frame and light is exact.
Vector3d truth(double t) {
  return Vector3d(0.1, 1.0, -0.2) + t * Vector3d(2.0, 4.0, -1.0) + 0.5 * t * t * Vector3d(0.0, -9.8, 1.0);
}

struct Recording {
  data::Trajectories start, smoothed;
  data::Derivatives rates;
};

/// Two LEDs; the second was never smoothed. Noise of 0.3, 0.3 and 0.9 mm on the axes of the first.
Recording recording() {
  Recording r;
  const TimeBase time{.rate_hz = 1000.0, .frames = kThrowFrames};
  r.start = r.smoothed = data::Trajectories::all_missing({"hand", "dark"}, time);
  r.start.sample_offset_s = {kLate_s, 0.0};
  for (auto* rates : {&r.rates.velocity, &r.rates.acceleration})
    rates->assign(r.start.x_in_world.size(), std::nan(""));
  r.rates.filters = {{.method = "kalman", .order = 4, .cutoff_hz = 9.0, .noise_sd_m = std::nan("")},
                     {.method = "none", .order = 0, .cutoff_hz = std::nan(""), .noise_sd_m = std::nan("")}};
  Random noise(4, 0);
  for (std::int64_t f = 0; f < kThrowFrames; ++f) {
    const double t = time.time_s(f);
    const std::size_t i = r.start.index(f, 0);
    r.start.x(f, 0) = truth(t + kLate_s) +
                      Vector3d(3e-4 * noise.gaussian(), 3e-4 * noise.gaussian(), 9e-4 * noise.gaussian());
    r.smoothed.x(f, 0) = truth(t);
    r.start.state[i] = r.smoothed.state[i] = SampleState::measured;
    const Vector3d a(0.0, -9.8, 1.0), v = Vector3d(2.0, 4.0, -1.0) + t * a;
    for (std::size_t k = 0; k < 3; ++k) {
      r.rates.velocity[3 * i + k] = v[static_cast<Eigen::Index>(k)];
      r.rates.acceleration[3 * i + k] = a[static_cast<Eigen::Index>(k)];
    }
  }
  r.start.set_missing(10, 0);
  r.smoothed.state[r.smoothed.index(11, 0)] = SampleState::model_filled;
  r.start.set_missing(12, 0, SampleState::rejected);
  return r;
}

Vector3d before(const data::Trajectories& t, std::int64_t f) {
  return Vector3d(t.unfiltered_in_world.data() + 3 * t.index(f, 0));
}

TEST(HandOnStart, FramesAreMovedToTheirOwnTime) {
  auto r = recording();
  hand_on_start(r.start, r.rates, r.smoothed);
  ASSERT_TRUE(r.smoothed.validate()) << r.smoothed.validate().error().message;
  for (std::int64_t f = 20; f < kThrowFrames; ++f) {
    const double t = r.smoothed.time.time_s(f);
    const Vector3d noise = r.start.x(f, 0) - truth(t + kLate_s);
    EXPECT_LT((before(r.smoothed, f) - truth(t) - noise).norm(), 1e-12) << f;
  }
  for (const std::int64_t f : {10, 11, 12}) EXPECT_TRUE(before(r.smoothed, f).array().isNaN().all()) << f;
  EXPECT_EQ(r.smoothed.made_by(0, 0), "smoothed by kalman");
  EXPECT_EQ(r.smoothed.made_by(11, 0), "") << "bridged, which others tell";
}

TEST(HandOnStart, TellsTheNoiseOfAFrame) {
  auto r = recording();
  for (std::int64_t f = 100; f < 110; ++f) r.start.x(f, 0) += Vector3d::Constant(0.5);  // a mirror flashed
  hand_on_start(r.start, r.rates, r.smoothed);
  EXPECT_NEAR(r.smoothed.filters[0].noise_sd_m, std::sqrt((9.0 + 9.0 + 81.0) / 3.0) * 1e-4, 0.3e-4);
  EXPECT_EQ(r.smoothed.filters[0].cutoff_hz, 9.0);
}

TEST(HandOnStart, WhatThePathIsUncertainByBelongsToTheNoise) {
  auto r = recording();
  r.smoothed.covariance.assign(6 * r.smoothed.state.size(), 0.0);
  for (std::size_t i = 0; i < r.smoothed.state.size(); ++i)
    for (const std::size_t d : {0U, 3U, 5U}) r.smoothed.covariance[6 * i + d] = 1e-6;
  hand_on_start(r.start, r.rates, r.smoothed);
  EXPECT_NEAR(r.smoothed.filters[0].noise_sd_m, std::sqrt(33e-8 + 1e-6), 0.3e-4);
}

TEST(HandOnStart, AnLedThatWasNotSmoothedHasNoneOfIt) {
  auto r = recording();
  hand_on_start(r.start, r.rates, r.smoothed);
  EXPECT_FALSE(data::was_filtered(r.smoothed, 1));
  EXPECT_FALSE(data::keeps_unfiltered(r.smoothed, 1));
}

TEST(HandOnStart, AFewFramesTellNoNoise) {
  auto r = recording();
  for (std::int64_t f = 5; f < kThrowFrames; ++f) r.start.set_missing(f, 0);
  hand_on_start(r.start, r.rates, r.smoothed);
  EXPECT_TRUE(std::isnan(r.smoothed.filters[0].noise_sd_m));
  EXPECT_TRUE(data::keeps_unfiltered(r.smoothed, 0));
}

}  // namespace
}  // namespace kinemark::trajectory
