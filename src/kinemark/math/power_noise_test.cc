// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/power_noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::math {
namespace {

constexpr double kRate_hz = 100.0;

double at_hz(const NoiseModel& model, double hz) { return model.power(hz / kRate_hz); }

TEST(PowerNoise, HasItsPowerWhereItCounts) {
  for (const double exponent : {0.5, 1.0, 1.5}) {
    const auto model = like_power(
        {.power = 3.0, .exponent = exponent, .floor = 0.0, .lowest = 0.02, .corner = 0.0}, kRate_hz);
    const double more = at_hz(model, 2.0) / 3.0;  // white noise was added for higher frequencies
    EXPECT_GE(more, 1.0 - 1e-9) << exponent;
    EXPECT_LT(more, 1.5) << exponent;
    EXPECT_NEAR(at_hz(model, 0.4) - model.floor, 3.0 * std::pow(5.0, exponent), 1e-6) << exponent;
    EXPECT_NEAR(at_hz(model, 6.0), 3.0 * std::pow(3.0, -exponent), 1e-6) << exponent;
  }
}

TEST(PowerNoise, HasNoMoreBelowItsCorner) {
  const PowerNoise noise{.power = 1.0, .exponent = 1.0, .floor = 0.1, .lowest = 0.02, .corner = 0.01};
  const auto model = like_power(noise, kRate_hz);
  EXPECT_NEAR(at_hz(model, 0.4) - model.floor, 2.0, 1e-6);
  EXPECT_GE(model.floor, 0.1);
  // A corner at the lowest frequency leaves white noise.
  auto flat = noise;
  flat.corner = flat.lowest;
  EXPECT_EQ(like_power(flat, kRate_hz).correlation, 0.0);
}

TEST(PowerNoise, SteeperThanARandomWalkIsARandomWalk) {
  const auto model =
      like_power({.power = 1.0, .exponent = 2.2, .floor = 0.0, .lowest = 0.02, .corner = 0.0}, kRate_hz);
  EXPECT_LE(model.correlation, 0.998);
  EXPECT_GT(at_hz(model, 0.4), 10.0);
  EXPECT_LT(at_hz(model, 0.4), 25.0);
}

}  // namespace
}  // namespace kinemark::math
