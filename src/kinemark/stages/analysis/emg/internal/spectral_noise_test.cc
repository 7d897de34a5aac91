// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/internal/spectral_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/emg/envelope.h"

namespace kinemark::analysis {
namespace {

using Eigen::VectorXd;

constexpr double kNoise_hz = 1000.0;
constexpr int kNoiseSamples = 8192;

VectorXd gaussian_noise(std::uint64_t seed) {
  Random random(seed, 9);
  VectorXd white(kNoiseSamples);
  for (double& x : white) x = random.gaussian();
  return white;
}

TEST(SpectralNoise, IndependentSamplesHaveTheVarianceOfOne) {
  SpectralNoise noise(gaussian_noise(1), kNoise_hz);
  EXPECT_NEAR(noise.variance_of_rectified(), 1.0 - 2.0 * std::numbers::inv_pi, 0.02);
}

TEST(SpectralNoise, MeansOfRectifiedDrawsScatterAsIsSaid) {
  SpectralNoise noise(band_passed(gaussian_noise(2), kNoise_hz, {.low_pass_hz = 120.0}), kNoise_hz);
  double sum = 0.0, squares = 0.0;
  constexpr int kMany = 400;
  for (int k = 0; k < kMany; ++k) {
    const double mean = noise.draw(1, 1, k).cwiseAbs().mean();
    sum += mean, squares += mean * mean;
  }
  EXPECT_NEAR(sum / kMany, std::sqrt(2.0 * std::numbers::inv_pi), 0.01);
  const double variance = squares / kMany - std::pow(sum / kMany, 2);
  EXPECT_NEAR(kNoiseSamples * variance / noise.variance_of_rectified(), 1.0, 0.25);
  EXPECT_GT(noise.variance_of_rectified(), 1.0) << "neighbours say less than as many that are independent";
}

TEST(SpectralNoise, ZerosDoNotScatter) {
  SpectralNoise noise(VectorXd::Zero(1000), kNoise_hz);
  EXPECT_EQ(noise.variance_of_rectified(), 0.0);
}

}  // namespace
}  // namespace kinemark::analysis
