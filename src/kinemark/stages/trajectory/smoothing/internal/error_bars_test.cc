// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/error_bars.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/smoothing/internal/iwp.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr double kSigma = 0.001;

Series series_of(const std::vector<double>& y, const std::vector<std::uint8_t>& seen) {
  return {std::ssize(y), 1, y.data(), seen.data(), nullptr, nullptr, 0.01};
}

TEST(ScaleBars, AreLeftAloneWhenTheModelIsRight) {
  // A movement that is an integrated Wiener process of the order and bandwidth assumed.
  constexpr int kFrames = 8000, kOrder = 3;
  const double cutoff_hz = 5.0, corner = corner_rad_s(kOrder, cutoff_hz);
  const double q = kSigma * kSigma * 0.01 * std::pow(corner, 2 * kOrder);
  Random random(1, 1);
  std::vector<double> y;
  double x = 0.0, v = 0.0, a = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    y.push_back(x + kSigma * random.gaussian());
    for (int sub = 0; sub < 20; ++sub) {
      const double h = 0.01 / 20;
      x += h * v + 0.5 * h * h * a;
      v += h * a;
      a += std::sqrt(q * h) * random.gaussian();
    }
  }
  const std::vector<std::uint8_t> seen(kFrames, 1);
  const std::vector<Series> parts{series_of(y, seen)};
  const BarScale scale = scale_bars(parts, kOrder, cutoff_hz, kSigma);
  for (std::size_t d = 0; d < 3; ++d) {
    EXPECT_NEAR(scale.seen[d], 1.0, 0.15) << d;
    EXPECT_NEAR(scale.added[d], 1.0, 0.2) << d;
  }
  EXPECT_NEAR(scale.interior[0], corner * 0.01 / (2 * kOrder * std::sin(M_PI / (2 * kOrder))),
              0.02 * scale.interior[0]);
}

TEST(ScaleBars, ShrinkWhereTheMovementEndsFarBelowTheCutoff) {
  // A sine of 1 Hz behind a filter of 8 Hz: only noise is left to be wrong, (2d + 1) / 2m of the model's
  // variance is not there.
  constexpr int kFrames = 30000, kOrder = 4;
  Random random(2, 1);
  std::vector<double> y;
  for (int i = 0; i < kFrames; ++i)
    y.push_back(0.2 * std::sin(2.0 * M_PI * 0.01 * i) + kSigma * random.gaussian());
  const std::vector<std::uint8_t> seen(kFrames, 1);
  const std::vector<Series> parts{series_of(y, seen)};
  const BarScale scale = scale_bars(parts, kOrder, 8.0, kSigma);
  for (const int d : {0, 1})
    EXPECT_NEAR(scale.seen[static_cast<std::size_t>(d)], 1.0 - (2.0 * d + 1.0) / (2.0 * kOrder), 0.2) << d;
  EXPECT_LT(scale.seen[2], 0.8);  // higher derivatives have less information
  EXPECT_LT(scale.seen[3], 0.9);
  EXPECT_LT(scale.added[0], 1.0);
}

TEST(ScaleBars, ShortRecordingsStayNearWhatIsUsual) {
  Random random(3, 1);
  std::vector<double> y;
  for (int i = 0; i < 30; ++i) y.push_back(0.1 * std::sin(0.1 * i) + kSigma * random.gaussian());
  const std::vector<std::uint8_t> seen(30, 1);
  const std::vector<Series> parts{series_of(y, seen)};
  const BarScale scale = scale_bars(parts, 4, 6.0, kSigma);
  for (std::size_t d = 0; d < 4; ++d) {
    EXPECT_GT(scale.seen[d], 0.1);
    EXPECT_LT(scale.seen[d], 2.0);
    EXPECT_GT(scale.added[d], 0.2);
    EXPECT_LT(scale.added[d], 5.0);
  }
}

}  // namespace
}  // namespace kinemark::trajectory::smoothing
