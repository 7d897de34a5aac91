// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/local_bias.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"

namespace kinemark::trajectory {
namespace {

constexpr double kRate = 100.0;
constexpr int kFrames = 600;
constexpr double kSigma = 0.0003;

/// A heel that swings forward and down and stops dead once a second; or one that never stops.
Eigen::Vector3d heel(double t, bool stops) {
  const double phase = t - std::floor(t);
  if (!stops) return {0.3 * std::sin(2.0 * M_PI * t), 0.1, 0.1 * std::cos(2.0 * M_PI * t)};
  const double swing = std::max(0.0, phase - 0.6) / 0.4;  // forward at full speed until the stop
  return {1.2 * (std::floor(t) + swing * swing * (1.5 - 0.5 * swing)), 0.1,
          0.15 * swing * swing * (1.0 - swing) * 4.0};
}

data::Trajectories recording(bool stops, std::uint64_t seed) {
  auto t = data::Trajectories::all_missing({"LHEE"}, {kRate, 0.0, kFrames});
  Random random(seed, 1);
  for (int f = 0; f < kFrames; ++f) {
    Eigen::Vector3d x = heel(f / kRate, stops);
    for (double& v : x) v += kSigma * random.gaussian();
    t.x(f, 0) = x;
    t.state[t.index(f, 0)] = data::SampleState::measured;
  }
  return t;
}

struct Ratio {
  double strikes = 0.0, elsewhere = 0.0;  // RMS of error / SD
};

Ratio ratio(const SmoothResult& smoothed, bool stops) {
  double sums[2] = {0.0, 0.0}, counts[2] = {0.0, 0.0};
  for (int f = 20; f < kFrames - 20; ++f) {
    const bool strike = std::abs(f - 100 * std::lround(f / 100.0)) <= 3;
    const double* c = smoothed.trajectories.covariance.data() + 6 * smoothed.trajectories.index(f, 0);
    const Eigen::Vector3d error = smoothed.trajectories.x(f, 0) - heel(f / kRate, stops);
    for (const auto& [axis, d] : {std::pair{0, 0}, {1, 3}, {2, 5}}) {
      sums[strike ? 0 : 1] += error[axis] * error[axis] / c[d];
      counts[strike ? 0 : 1] += 1.0;
    }
  }
  return {std::sqrt(sums[0] / counts[0]), std::sqrt(sums[1] / counts[1])};
}

TEST(LocalBias, IsInTheErrorBarsWhereAHeelStops) {
  for (const FilterMethod method : {FilterMethod::kalman, FilterMethod::butterworth}) {
    SmoothOptions options;
    options.method = method;
    options.cutoff_hz = 8.0;
    options.noise_sd_m = kSigma;
    const auto smoothed = smooth(recording(true, 3), options);
    ASSERT_TRUE(smoothed.has_value());
    const Ratio z = ratio(*smoothed, true);
    EXPECT_LT(z.strikes, 1.6);
    EXPECT_GT(z.strikes, 0.4);
    EXPECT_LT(z.elsewhere, 1.8);
  }
}

TEST(LocalBias, LeavesASmoothMovementAsItIs) {
  SmoothOptions options;
  options.cutoff_hz = 8.0;
  options.noise_sd_m = kSigma;
  const auto smoothed = smooth(recording(false, 4), options);
  ASSERT_TRUE(smoothed.has_value());
  const double first = smoothed->trajectories.covariance[at(6 * 100)];
  int wider = 0;
  for (int f = 100; f < 500; ++f)
    wider += smoothed->trajectories.covariance[at(6 * f)] > 1.001 * first ? 1 : 0;
  EXPECT_LE(wider, 20);
  const Ratio z = ratio(*smoothed, false);
  EXPECT_NEAR(z.strikes, 1.0, 0.4);
  EXPECT_NEAR(z.elsewhere, 1.0, 0.4);
}

TEST(LocalBias, IsInTheErrorBarsOfTheFilterThatIsFound) {
  // A narrow jump beside a wide filter: single frames err, in alternating directions.
  double strikes = 0.0, elsewhere = 0.0;
  for (std::uint64_t seed = 10; seed < 16; ++seed) {
    const auto smoothed = smooth(recording(true, seed), {});
    ASSERT_TRUE(smoothed.has_value());
    const Ratio z = ratio(*smoothed, true);
    strikes += z.strikes / 6.0, elsewhere += z.elsewhere / 6.0;
  }
  EXPECT_LT(strikes, 1.2);
  EXPECT_GT(strikes, 0.5);
  EXPECT_LT(elsewhere, 1.2);
}

TEST(LocalBias, IsWhatTheFilterTakesFromARamp) {
  // A mean of three frames rounds the corner of a ramp off by a third of its slope, at the corner alone.
  smoothing::MarkerSamples samples;
  samples.frames = 200;
  samples.interval_s = 0.01;
  samples.present.assign(200, 1);
  samples.judged = samples.present;
  samples.x.assign(600, 0.0);
  MarkerResult result;
  result.x.assign(600, 0.0);
  result.covariance.assign(1200, 1e-12);
  Random random(1, 1);
  for (double& x : samples.x) x = 1e-4 * random.gaussian();
  samples.x[300] = -0.01;
  result.account.used.cutoff_hz = 6.0;
  result.account.used.noise_sd_m = 1e-4;
  const std::vector<double> response{0.0, 0.0, 0.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 0.0, 0.0, 0.0};
  smoothing::add_local_bias(samples, response, result);
  EXPECT_NEAR(std::sqrt(result.covariance[at(6 * 100)]), 0.01, 1e-3);
  EXPECT_LT(std::sqrt(result.covariance[at(6 * 102)]), 2e-4);
  EXPECT_LT(std::sqrt(result.covariance[at(6 * 40)]), 1e-4);
}

TEST(LocalBias, NeedsTheSizeOfTheNoiseAndAResponse) {
  smoothing::MarkerSamples samples;
  samples.frames = 1;
  samples.interval_s = 0.01;
  samples.x.assign(3, 1.0);
  samples.present.assign(1, 1);
  samples.judged = samples.present;
  MarkerResult result;
  result.x.assign(3, 0.0);
  result.covariance.assign(6, 1e-8);
  result.account.used.cutoff_hz = 6.0;
  result.account.used.noise_sd_m = std::nan("");
  const std::vector<double> response{0.25, 0.5, 0.25};
  smoothing::add_local_bias(samples, response, result);
  EXPECT_EQ(result.covariance[0], 1e-8);
  result.account.used.noise_sd_m = 1e-4;
  smoothing::add_local_bias(samples, {}, result);
  EXPECT_EQ(result.covariance[0], 1e-8);
  smoothing::add_local_bias(samples, response, result);
  EXPECT_NEAR(result.covariance[0], 1.0, 1e-2);
}

}  // namespace
}  // namespace kinemark::trajectory
