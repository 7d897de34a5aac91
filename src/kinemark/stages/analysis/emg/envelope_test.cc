// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/envelope.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kinemark::analysis {
namespace {

using Eigen::VectorXd;
constexpr double kSampled_hz = 2000.0;
constexpr int kSamples = 8000;

VectorXd tone(double hz, double amplitude = 1.0) {
  VectorXd x(kSamples);
  for (int i = 0; i < kSamples; ++i)
    x[i] = amplitude * std::sin(2.0 * std::numbers::pi * hz * i / kSampled_hz);
  return x;
}

double middle_rms(const VectorXd& x) { return std::sqrt(x.segment(2000, 4000).squaredNorm() / 4000.0); }

TEST(Envelope, TheBandPassesWhatIsInItAndHalvesItsEdges) {
  const EnvelopeOptions options;
  const double whole = std::sqrt(0.5);
  EXPECT_NEAR(middle_rms(band_passed(tone(120.0), kSampled_hz, options)), whole, 2e-3);
  EXPECT_NEAR(middle_rms(band_passed(tone(20.0), kSampled_hz, options)), 0.5 * whole, 2e-3);
  EXPECT_NEAR(middle_rms(band_passed(tone(450.0), kSampled_hz, options)), 0.5 * whole, 2e-3);
  EXPECT_LT(middle_rms(band_passed(tone(5.0), kSampled_hz, options)), 1e-4);
  EXPECT_LT(middle_rms(band_passed(VectorXd::Constant(kSamples, 3.0), kSampled_hz, options)), 1e-9);
  // Bilinear Butterworth of fourth order: 1 / (1 + (tan(pi c) / tan(pi f))^8), both ways.
  const double ratio =
      std::tan(std::numbers::pi * 20.0 / kSampled_hz) / std::tan(std::numbers::pi * 40.0 / kSampled_hz);
  EXPECT_NEAR(middle_rms(band_passed(tone(40.0), kSampled_hz, options)), whole / (1.0 + std::pow(ratio, 8)),
              1e-4);
}

TEST(Envelope, ALowRateHasNoUpperEdge) {
  const EnvelopeOptions options;
  VectorXd x(2000);
  for (int i = 0; i < 2000; ++i) x[i] = std::sin(2.0 * std::numbers::pi * 100.0 * i / 500.0);
  EXPECT_NEAR(std::sqrt(band_passed(x, 500.0, options).segment(500, 1000).squaredNorm() / 1000.0),
              std::sqrt(0.5), 2e-3);
}

TEST(Envelope, OfASinusoidItIsTheMeanOrTheRootMeanSquare) {
  const VectorXd x = tone(100.0, 0.3);
  const auto mean = envelope_of(x, kSampled_hz, {});
  EXPECT_NEAR(mean.segment(3000, 2000).mean(), 0.3 * 2.0 / std::numbers::pi, 3e-3);
  const auto rms = envelope_of(x, kSampled_hz, {.rms_window_s = 0.1});
  EXPECT_NEAR(rms[4000], 0.3 * std::sqrt(0.5), 2e-3);
  EXPECT_GE(mean.minCoeff(), 0.0);
}

TEST(Envelope, TheMedianFrequencyHalvesThePower) {
  EXPECT_NEAR(median_frequency(tone(120.0), kSampled_hz), 120.0, 1.0);
  EXPECT_NEAR(median_frequency(tone(80.0) + tone(200.0, 2.0), kSampled_hz), 200.0, 2.0);
  EXPECT_TRUE(std::isnan(median_frequency(VectorXd::Zero(kSamples), kSampled_hz)));
  EXPECT_TRUE(std::isnan(median_frequency(VectorXd::Zero(3), kSampled_hz)));
}

TEST(Envelope, OptionsAreChecked) {
  EXPECT_TRUE(EnvelopeOptions{}.check());
  EXPECT_EQ((EnvelopeOptions{.high_pass_hz = 500.0}.check().error().code), Code::usage);
  EXPECT_FALSE((EnvelopeOptions{.envelope_hz = 0.0}.check()));
  EXPECT_FALSE((EnvelopeOptions{.rms_window_s = -1.0}.check()));
}

}  // namespace
}  // namespace kinemark::analysis
