// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/coupling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kinemark::analysis {
namespace {

using Eigen::VectorXd;
constexpr double kWhole = 2.0 * std::numbers::pi;

/// Three turns of a sinusoid in 120 samples.
VectorXd wave(double amplitude, double phase, double offset = 0.0) {
  VectorXd x(120);
  for (int i = 0; i < 120; ++i) x[i] = offset + amplitude * std::cos(kWhole * i / 40.0 + phase);
  return x;
}

TEST(Coupling, ThePhaseOfASinusoidIsItsOwn) {
  const VectorXd phase = hilbert_phase(wave(0.4, 0.7, 3.0));
  for (int i = 0; i < 120; ++i)
    EXPECT_NEAR(std::remainder(phase[i] - kWhole * i / 40.0 - 0.7, kWhole), 0.0, 0.02) << i;
  // With its middle on a sample exactly.
  const VectorXd exact = hilbert_phase(wave(0.4, 0.0, 3.0));
  for (int i = 0; i < 120; ++i) EXPECT_NEAR(std::remainder(exact[i] - kWhole * i / 40.0, kWhole), 0.0, 1e-9);
}

TEST(Coupling, RelativePhaseIsPositiveWhereTheFirstLeads) {
  const auto lead = relative_phase(wave(1.0, kWhole / 4.0), wave(0.2, 0.0, 5.0));
  EXPECT_NEAR(lead.mean, kWhole / 4.0, 1e-9);
  EXPECT_NEAR(lead.locking, 1.0, 1e-9);
  EXPECT_NEAR(relative_phase(wave(0.2, 0.0), wave(1.0, kWhole / 4.0)).mean, -kWhole / 4.0, 1e-9);
  EXPECT_NEAR(std::abs(relative_phase(wave(1.0, 0.0), -wave(1.0, 0.0)).mean), kWhole / 2.0, 1e-9);
}

TEST(Coupling, DifferentFrequenciesAreNotLocked) {
  VectorXd other(120);
  for (int i = 0; i < 120; ++i) other[i] = std::cos(kWhole * i / 24.0);
  EXPECT_LT(relative_phase(wave(1.0, 0.0), other).locking, 1e-6);
  EXPECT_TRUE(std::isnan(relative_phase(wave(1.0, 0.0), VectorXd::Constant(120, 2.0)).mean));
  EXPECT_TRUE(std::isnan(relative_phase(VectorXd::Zero(5), VectorXd::Zero(5)).locking));
}

TEST(Coupling, TheLagOfAShiftedPulseIsItsShift) {
  const auto pulse = [](double at) {
    VectorXd x(200);
    for (int i = 0; i < 200; ++i) x[i] = std::exp(-0.5 * std::pow((i - at) / 9.0, 2));
    return x;
  };
  const auto late = cross_correlation(pulse(90.0), 3.0 * pulse(102.0));
  EXPECT_NEAR(late.lag, 12.0, 0.05);
  EXPECT_NEAR(late.correlation, 1.0, 1e-6);
  const auto early = cross_correlation(pulse(90.0), -pulse(85.6));
  EXPECT_NEAR(early.lag, -4.4, 0.05);
  EXPECT_LT(early.correlation, -0.999);
  EXPECT_TRUE(std::isnan(cross_correlation(pulse(90.0), VectorXd::Zero(200)).lag));
}

TEST(Coupling, SharesAreOfTheDirectionsInThePlane) {
  VectorXd a(9), b(9);
  // Alike, alike, contrary, a alone forth and back, b alone, still, b alone back, alike downwards.
  a << 0, 1, 2, 3, 5, 4, 4, 4, 4;
  b << 0, 1, 2, 1, 1, 1, 3, 3, 2;
  const auto shares = coordination_shares(a, b);
  EXPECT_NEAR(shares[0], 2.0 / 7.0, 1e-12);
  EXPECT_NEAR(shares[1], 1.0 / 7.0, 1e-12);
  EXPECT_NEAR(shares[2], 2.0 / 7.0, 1e-12);
  EXPECT_NEAR(shares[3], 2.0 / 7.0, 1e-12);
  EXPECT_NEAR(coordination_shares(a, -b)[1], 2.0 / 7.0, 1e-12);
  EXPECT_TRUE(std::isnan(coordination_shares(VectorXd::Zero(4), VectorXd::Zero(4))[0]));
}

}  // namespace
}  // namespace kinemark::analysis
