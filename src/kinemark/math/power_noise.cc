// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/power_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinemark::math {
namespace {

constexpr double kSlow_hz = 0.4;        // where the power below the fitted frequencies counts
constexpr double kHigher = 3.0;         // times the lowest frequency, where more of it counts
constexpr double kLeastForget = 0.002;  // 1 - rho

double squared_sine(double frequency) {
  const double s = std::sin(std::numbers::pi * frequency);
  return 4.0 * s * s;
}

}  // namespace

NoiseModel like_power(const PowerNoise& noise, double rate_hz) {
  NoiseModel out{.kind = NoiseKind::correlated_and_white, .variance = noise.power, .floor = noise.floor};
  const double at = kSlow_hz / rate_hz, below = squared_sine(at), here = squared_sine(noise.lowest);
  const double steepest = 0.999 * here / below;  // of what is autoregressive
  const double times = std::min(
      steepest,
      std::pow(noise.lowest / std::clamp(noise.corner, at, std::max(at, noise.lowest)), noise.exponent));
  if (!(times > 1.0)) return out;
  const double q = (here - times * below) / (times - 1.0);  // (1 - rho)^2 / rho
  out.correlation = std::min(1.0 - kLeastForget, 0.5 * (2.0 + q - std::sqrt(q * (q + 4.0))));
  const auto down = [rho = out.correlation](double sine) { return (1.0 - rho) * (1.0 - rho) + rho * sine; };
  out.variance = noise.power * down(here) / (1.0 - out.correlation * out.correlation);
  const double higher = std::min(kHigher * noise.lowest, 0.45);
  const double has = noise.power * down(here) / down(squared_sine(higher));
  out.floor += std::max(0.0, noise.power * std::pow(higher / noise.lowest, -noise.exponent) - has);
  return out;
}

}  // namespace kinemark::math
