// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/fourier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "kinemark/core/random.h"

namespace kinemark::math {
namespace {

Eigen::VectorXd random_series(std::int64_t n) {
  Random random(3, static_cast<std::uint64_t>(n));
  Eigen::VectorXd out(n);
  for (double& x : out) x = random.gaussian();
  return out;
}

double power_by_its_sum(const Eigen::VectorXd& series, std::int64_t k, std::int64_t length) {
  std::complex<double> sum = 0.0;
  for (std::int64_t i = 0; i < series.size(); ++i)
    sum += series[i] * std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(i * k % length) /
                                           static_cast<double>(length));
  return std::norm(sum);
}

TEST(FourierTransform, HasThePowersOfItsDefinition) {
  for (const std::int64_t length : {8, 16, 24, 40, 96, 160, 480, 512, 1440}) {
    FourierTransform transform(length);
    for (const std::int64_t n : {length, length - 5}) {
      const auto series = random_series(n);
      Eigen::VectorXd power = Eigen::VectorXd::Zero(length / 2 + 1);
      transform.add_power(series, power);
      for (std::int64_t k = 0; k < power.size(); ++k)
        ASSERT_NEAR(power[k], power_by_its_sum(series, k, length), 1e-11 * static_cast<double>(length))
            << length << " " << k;
    }
  }
}

TEST(FourierTransform, KeepsTheSumOfSquares) {
  const std::int64_t length = 6000;
  const auto series = random_series(length);
  FourierTransform transform(length);
  Eigen::VectorXd power = Eigen::VectorXd::Zero(length / 2 + 1);
  transform.add_power(series, power);
  const double all = 2.0 * power.sum() - power[0] - power[length / 2];
  EXPECT_NEAR(all / (static_cast<double>(length) * series.squaredNorm()), 1.0, 1e-12);
}

TEST(FourierTransform, AddsToWhatIsThereAndGoesAsFarAsIsAskedFor) {
  FourierTransform transform(96);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(49), some = Eigen::VectorXd::Ones(10);
  transform.add_power(random_series(90), all);
  transform.add_power(random_series(90), some);
  EXPECT_LT((some - Eigen::VectorXd::Ones(10) - all.head(10)).norm(), 1e-12 * all.norm());
}

TEST(FourierTransform, TellsWhichLengthsFit) {
  EXPECT_TRUE(FourierTransform::fits(8));
  EXPECT_TRUE(FourierTransform::fits(14400));
  for (const std::int64_t length : {0, 4, 20, 56, 8 * 7 * 3})
    EXPECT_FALSE(FourierTransform::fits(length)) << length;
  EXPECT_EQ(FourierTransform::good_length(1), 8);
  EXPECT_EQ(FourierTransform::good_length(997), 1000);
  EXPECT_EQ(FourierTransform::good_length(161), 192);
  EXPECT_EQ(FourierTransform::good_length(14362), 14400);
  EXPECT_EQ(FourierTransform::good_length(2501) % 32, 0);
}

}  // namespace
}  // namespace kinemark::math
