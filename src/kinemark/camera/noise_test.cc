// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::camera {
namespace {

const data::Electronics kRig1986;

TEST(Noise, AmplifierOf1986) {
  EXPECT_NEAR(1e12 * std::sqrt(current_noise_a2_hz(kRig1986)), 3.32, 0.005);
  EXPECT_NEAR(noise_bandwidth_hz(kRig1986), 1.0 / (4.0 * 35e-6), 1e-9);
  EXPECT_NEAR(1e9 * amplifier_noise_counts(kRig1986, 0.0) * kRig1986.count_a(), 0.281, 5e-4);
  EXPECT_NEAR(std::sqrt(conversion_variance(kRig1986, 600.0)), 1.12, 0.005);
}

TEST(Noise, ShotNoiseGrowsWithTheSignal) {
  const double dark = conversion_variance(kRig1986, 0.0);
  const double one = conversion_variance(kRig1986, 1000.0) - dark;
  EXPECT_NEAR(conversion_variance(kRig1986, 3000.0) - dark, 3.0 * one, 1e-12);
  EXPECT_EQ(conversion_variance(kRig1986, -1000.0), conversion_variance(kRig1986, 1000.0));
  // 2 q I B of 1000 counts, in counts^2
  const double current = 1000.0 * kRig1986.count_a();
  EXPECT_NEAR(one, 2.0 * 1.602e-19 * current * 7142.857 / std::pow(kRig1986.count_a(), 2), 1e-7);
}

TEST(Noise, AQuietConverterStillRounds) {
  data::Electronics quiet = kRig1986;
  quiet.converter_noise_counts = 0.0;
  const double amplifier = amplifier_noise_counts(quiet, 0.0);
  EXPECT_NEAR(conversion_variance(quiet, 0.0) - amplifier * amplifier, 1.0 / 12.0, 1e-15);
}

}  // namespace
}  // namespace kinemark::camera
