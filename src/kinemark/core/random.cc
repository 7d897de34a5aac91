// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/random.h"

#include <cmath>
#include <numbers>

namespace kinemark {

Random::Random(std::uint64_t seed, std::uint64_t stream)
    : key_(mix64(seed) ^ mix64(stream + 0x632BE59BD9B4E019ULL)) {}

double Random::uniform() {
  ++counter_;
  const std::uint64_t bits = mix64(key_ + counter_ * 0x9E3779B97F4A7C15ULL);
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

double Random::gaussian() {
  const double u1 = uniform();
  const double u2 = uniform();
  return std::sqrt(-2.0 * std::log(1.0 - u1)) * std::cos(2.0 * std::numbers::pi * u2);
}

}  // namespace kinemark
