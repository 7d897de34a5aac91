// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/internal/rails.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/emg/envelope.h"

namespace kinemark::analysis {
namespace {

using Eigen::VectorXd;

constexpr double kRails_hz = 1000.0;

VectorXd noise_of_unit_power(std::uint64_t seed) {
  Random random(seed, 8);
  VectorXd white(6000);
  for (double& x : white) x = random.gaussian();
  const VectorXd band = band_passed(white, kRails_hz, {.low_pass_hz = 300.0});
  return band / std::sqrt(band.squaredNorm() / 6000.0);
}

TEST(Rails, ValuesHeapedOnAnExtremeAreOne) {
  for (std::uint64_t seed = 1; seed < 8; ++seed)
    for (const double level : {0.3, 1.0, 2.0, 2.5}) {
      const VectorXd x = noise_of_unit_power(seed);
      const VectorXd both = x.cwiseMax(-level).cwiseMin(level).array() + 0.5;
      const auto found = find_rails(both, kRails_hz);
      EXPECT_DOUBLE_EQ(found.low, 0.5 - level);
      EXPECT_DOUBLE_EQ(found.high, 0.5 + level);
      EXPECT_NEAR(found.share, std::erfc(level / std::sqrt(2.0)), 0.05) << level;
      const auto above = find_rails(x.cwiseMin(level), kRails_hz);
      EXPECT_TRUE(std::isnan(above.low));
      EXPECT_DOUBLE_EQ(above.high, level);
      const auto below = find_rails(x.cwiseMax(-level), kRails_hz);
      EXPECT_DOUBLE_EQ(below.low, -level);
      EXPECT_TRUE(std::isnan(below.high));
    }
}

TEST(Rails, ARecordingThatIsWholeHasNone) {
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const VectorXd x = noise_of_unit_power(seed);
    EXPECT_EQ(find_rails(x, kRails_hz).share, 0.0);
    EXPECT_EQ(find_rails(x.cwiseAbs(), kRails_hz).share, 0.0) << "rectified";
    for (const double step : {0.001, 0.1, 0.5, 1.5}) {
      const VectorXd counts = (x / step).array().round() * step;
      EXPECT_EQ(find_rails(counts, kRails_hz).share, 0.0) << "counts of " << step;
    }
  }
}

TEST(Rails, AValueThatLastsIsNone) {
  VectorXd x = noise_of_unit_power(3).array() + 6.0;
  x.head(2000).setZero();
  EXPECT_EQ(find_rails(x, kRails_hz).share, 0.0) << "zeros before the recording";
  for (int i = 0; i < 6000; ++i) x[i] = (i / 300) % 2;
  EXPECT_EQ(find_rails(x, kRails_hz).share, 0.0) << "a switch";
}

}  // namespace
}  // namespace kinemark::analysis
